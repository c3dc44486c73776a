# Many small instantiations: less optimisation halves the time to compile them. The rooms themselves keep theirs.
if(TARGET test_basis)
  target_compile_options(test_basis PRIVATE $<$<CONFIG:Release>:-O1>)
endif()
