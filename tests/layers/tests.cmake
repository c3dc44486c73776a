# No include against the order of the rooms; and the check finds one where there is one.
set(check_layers ${WISP_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/check_layers.py)
add_test(NAME layers COMMAND ${check_layers} ${PROJECT_SOURCE_DIR})
add_test(NAME layers_finds_a_fault COMMAND ${check_layers} ${CMAKE_CURRENT_LIST_DIR}/wrong)
set_tests_properties(layers_finds_a_fault PROPERTIES
  PASS_REGULAR_EXPRESSION "src/low/below.h:2: low .layer 1. includes high/above.h .layer 2.\n1 includes")
