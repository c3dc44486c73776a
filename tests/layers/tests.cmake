# What the compiler does not check: the order of the rooms, lengths of files, empty names.
add_test(NAME layers COMMAND ${WISP_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/layers/check_layers.py ${PROJECT_SOURCE_DIR})
add_test(NAME layers.self_test COMMAND ${WISP_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/layers/check_layers.py --self-test)
