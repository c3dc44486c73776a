# Some tests run the executable.
add_dependencies(test_app wisp)
target_compile_definitions(test_app PRIVATE WISP_PROGRAM="$<TARGET_FILE:wisp>")
