# Results read back by VTK's own reader and by the Python package, each in a process of its own.
add_executable(write_samples ${CMAKE_CURRENT_LIST_DIR}/write_samples.cc)
target_include_directories(write_samples PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(write_samples PRIVATE wisp_io)

set(samples ${CMAKE_CURRENT_BINARY_DIR}/io_samples)
add_test(NAME io.samples COMMAND write_samples ${samples})
set_tests_properties(io.samples PROPERTIES FIXTURES_SETUP io_samples)
add_test(NAME io.vtk COMMAND ${WISP_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/read_vtu.py ${samples})
set_tests_properties(io.vtk PROPERTIES FIXTURES_REQUIRED io_samples)
add_test(NAME io.python COMMAND ${WISP_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/test_python.py ${samples})
set_tests_properties(io.python PROPERTIES FIXTURES_REQUIRED io_samples
                     ENVIRONMENT "PYTHONPATH=${PROJECT_SOURCE_DIR}/python")
