# Runs of the program itself: on several ranks, killed and resumed, with bad input.
set(run_tests ${CMAKE_CURRENT_LIST_DIR})
foreach(ranks 2 4)
  add_test(NAME run.${ranks}_ranks COMMAND ${WISP_PYTHON} ${run_tests}/test_ranks.py $<TARGET_FILE:wisp> ${ranks})
  add_test(NAME run.killed_on_${ranks}_ranks
           COMMAND ${WISP_PYTHON} ${run_tests}/test_killed.py $<TARGET_FILE:wisp> ${ranks})
  set_tests_properties(run.${ranks}_ranks run.killed_on_${ranks}_ranks PROPERTIES PROCESSORS ${ranks})
endforeach()
add_test(NAME run.killed COMMAND ${WISP_PYTHON} ${run_tests}/test_killed.py $<TARGET_FILE:wisp> 1)
add_test(NAME run.words COMMAND ${WISP_PYTHON} ${run_tests}/test_words.py $<TARGET_FILE:wisp>)
set_tests_properties(run.2_ranks run.4_ranks run.killed run.killed_on_2_ranks run.killed_on_4_ranks run.words
                     PROPERTIES ENVIRONMENT "PYTHONPATH=${PROJECT_SOURCE_DIR}/python" TIMEOUT 600)

file(GLOB examples CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/examples/*/case.toml)
foreach(example IN LISTS examples)
  cmake_path(GET example PARENT_PATH folder)
  cmake_path(GET folder FILENAME name)
  add_test(NAME example.${name} COMMAND ${WISP_PYTHON} ${run_tests}/test_examples.py $<TARGET_FILE:wisp> ${example})
  set_tests_properties(example.${name} PROPERTIES ENVIRONMENT "PYTHONPATH=${PROJECT_SOURCE_DIR}/python" TIMEOUT 300)
endforeach()
