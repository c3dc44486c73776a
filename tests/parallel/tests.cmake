# The same program on several ranks; on one rank it is the test `parallel`.
set(WISP_MPIRUN mpirun --oversubscribe --quiet)
execute_process(COMMAND id -u OUTPUT_VARIABLE wisp_user OUTPUT_STRIP_TRAILING_WHITESPACE)
if(wisp_user STREQUAL "0")
  list(APPEND WISP_MPIRUN --allow-run-as-root)
endif()
foreach(ranks 2 3 4)
  add_test(NAME parallel.${ranks}_ranks COMMAND ${WISP_MPIRUN} -n ${ranks} $<TARGET_FILE:test_parallel>)
  set_tests_properties(parallel.${ranks}_ranks PROPERTIES PROCESSORS ${ranks} TIMEOUT 120)
endforeach()
# A failure on one rank only must fail the whole run, or these tests prove nothing.
add_test(NAME parallel.failure_on_one_rank
         COMMAND ${WISP_MPIRUN} -x WISP_FAIL_ON_RANK=1 -n 3 $<TARGET_FILE:test_parallel>
                 --gtest_filter=Session.FailsOnTheRankItIsToldTo)
set_tests_properties(parallel.failure_on_one_rank PROPERTIES WILL_FAIL TRUE PROCESSORS 3 TIMEOUT 120)
# A rank that fails alone must not leave the others waiting for ever.
add_test(NAME parallel.one_rank_ends_all
         COMMAND sh -c "\"$@\"; echo status $?" sh ${WISP_MPIRUN} -x WISP_FAIL_ALONE_ON_RANK=1 -n 3
                 $<TARGET_FILE:test_parallel> --gtest_filter=Session.KnowsWhetherAllRanksFailed)
set_tests_properties(parallel.one_rank_ends_all PROPERTIES
  PASS_REGULAR_EXPRESSION "failed together: no.*status 1" PROCESSORS 3 TIMEOUT 60)
