# Many small instantiations: less optimisation halves the time to compile them. The rooms themselves keep theirs.
if(TARGET test_boundary)
  target_compile_options(test_boundary PRIVATE $<$<CONFIG:Release>:-O1>)
endif()
