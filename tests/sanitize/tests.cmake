# The unit tests (test_<room>) as one target and one ctest label, so that a sanitizer build can stop there; and in such a
# build what they need to tell our leaks from those of MPI.
add_custom_target(unit_tests)
foreach(room IN LISTS WISP_ROOMS)
  if(TARGET test_${room})
    add_dependencies(unit_tests test_${room})
    set_property(TEST ${room} APPEND PROPERTY LABELS unit)
    if(WISP_SANITIZE)
      target_sources(test_${room} PRIVATE ${CMAKE_CURRENT_LIST_DIR}/keep_loaded.c)
      set_property(TEST ${room} APPEND PROPERTY ENVIRONMENT
        ASAN_OPTIONS=detect_leaks=1
        UBSAN_OPTIONS=print_stacktrace=1
        LSAN_OPTIONS=suppressions=${CMAKE_CURRENT_LIST_DIR}/leaks.txt:print_suppressions=0)
    endif()
  endif()
endforeach()
