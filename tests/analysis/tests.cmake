if(TARGET test_analysis)
  target_compile_options(test_analysis PRIVATE $<$<CONFIG:Release>:-O1>)  # compiles in half the time; the rooms keep their optimisation
endif()
# Results on several ranks against those on one. The program on one rank writes what the others compare with.
find_program(WISP_MPIRUN mpirun)
if(WISP_MPIRUN AND TARGET test_analysis)
  add_executable(analysis_ranks ${CMAKE_CURRENT_LIST_DIR}/ranks.cc)
  target_include_directories(analysis_ranks PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_link_libraries(analysis_ranks PRIVATE wisp_analysis GTest::gtest)
  target_compile_options(analysis_ranks PRIVATE $<$<CONFIG:Release>:-O1>)
  set(reference ${CMAKE_CURRENT_BINARY_DIR}/one_rank)
  add_test(NAME analysis-1-rank COMMAND analysis_ranks ${reference})
  set_tests_properties(analysis-1-rank PROPERTIES FIXTURES_SETUP one-rank)
  foreach(n 2 3 4)
    add_test(NAME analysis-${n}-ranks COMMAND ${WISP_MPIRUN} --oversubscribe --allow-run-as-root -n ${n}
                                              $<TARGET_FILE:analysis_ranks> ${reference})
    set_tests_properties(analysis-${n}-ranks PROPERTIES FIXTURES_REQUIRED one-rank)
  endforeach()
endif()
