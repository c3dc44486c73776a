# Many small instantiations: less optimisation halves the time to compile them. The rooms themselves keep theirs.
if(TARGET test_stabilise)
  target_compile_options(test_stabilise PRIVATE $<$<CONFIG:Release>:-O1>)
endif()
