# The unit tests (test_<room>, and of the verification its references) as one target and one ctest label, so that a
# sanitizer build can stop there; and in such a build what they need to tell our leaks from those of MPI.
add_custom_target(unit_tests)
set(wisp_sanitize_folder ${CMAKE_CURRENT_LIST_DIR})
set_source_files_properties(${wisp_sanitize_folder}/keep_loaded.c PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
function(wisp_unit_test name)
  add_dependencies(unit_tests test_${name})
  set_property(TEST ${name} APPEND PROPERTY LABELS unit)
  if(WISP_SANITIZE)
    target_sources(test_${name} PRIVATE ${wisp_sanitize_folder}/keep_loaded.c)
    set_property(TEST ${name} APPEND PROPERTY ENVIRONMENT
      ASAN_OPTIONS=detect_leaks=1
      UBSAN_OPTIONS=print_stacktrace=1
      LSAN_OPTIONS=suppressions=${wisp_sanitize_folder}/leaks.txt:print_suppressions=0)
    if(wisp_slow_${name})
      list(JOIN wisp_slow_${name} ":" slow)
      set_property(TEST ${name} APPEND PROPERTY ENVIRONMENT GTEST_FILTER=-${slow})
    endif()
    if(name STREQUAL analysis)  # the longest by far: its other half runs beside it
      get_property(environment TEST ${name} PROPERTY ENVIRONMENT)
      add_test(NAME ${name}-second-half COMMAND test_${name})
      set_property(TEST ${name}-second-half PROPERTY LABELS unit)
      set_property(TEST ${name}-second-half PROPERTY ENVIRONMENT ${environment} GTEST_TOTAL_SHARDS=2 GTEST_SHARD_INDEX=1)
      set_property(TEST ${name} APPEND PROPERTY ENVIRONMENT GTEST_TOTAL_SHARDS=2 GTEST_SHARD_INDEX=0)
    endif()
  endif()
endfunction()
# Left out under the sanitizers, where a step costs a hundred times as much: long runs that measure rates, periods
# and momenta (the longest of the Release build, which runs them all). The shorter tests of
# the room run through the same code.
set(wisp_slow_basis
  Projection.ConvergesAtTheRateOfEachBasis
  SplineConditionsTest/1.PoissonAndProjectionsWithPrescribedBoundariesConvergeAtTheFullRate)
set(wisp_slow_analysis
  ExplicitSpectrum.IsTheStepAtWhichARunBlowsUp
  BSplines.TranslationIsExactAndStressFree
  VibratingBar.EnergyRecordsOfTheSchemes
  Vortex.ConvergesUnderRefinement
  Triangles.MomentumStaysWithGhostAndAngularMomentumToFirstOrder
  Triangles.TranslationIsExactAndStressFree
  Triangles.BarVibratesWithTheExactPeriod
  VibratingBar.HasItsFrequencyAndAmplitudeInEveryExplicitScheme
  Collision.OfTwoDiscsKeepsTheMomentumAndTurnsThemBack)
foreach(room IN LISTS WISP_ROOMS)
  if(TARGET test_${room})
    wisp_unit_test(${room})
  endif()
endforeach()
