# The room's tests once more on two ranks.
find_program(WISP_MPIRUN mpirun)
if(WISP_MPIRUN AND TARGET test_linear)
  add_test(NAME linear-2-ranks COMMAND ${WISP_MPIRUN} --oversubscribe --allow-run-as-root -n 2 $<TARGET_FILE:test_linear>)
endif()
