# The references of the verification; its tables are run by `wisp verify`.
add_executable(test_verification ${CMAKE_CURRENT_LIST_DIR}/references_test.cc
                                 ${PROJECT_SOURCE_DIR}/verification/powell_sabin/exact.cpp
                                 ${PROJECT_SOURCE_DIR}/verification/powell_sabin/ulfem.cpp)
target_include_directories(test_verification PRIVATE ${PROJECT_SOURCE_DIR})
target_link_libraries(test_verification PRIVATE wisp_options GTest::gtest_main)
add_test(NAME verification COMMAND test_verification)
wisp_unit_test(verification)
