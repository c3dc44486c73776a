# Links, citations and the cases shown in pages.
if(TARGET wisp)
  add_test(NAME documentation COMMAND ${WISP_PYTHON} ${PROJECT_SOURCE_DIR}/scripts/check-docs $<TARGET_FILE:wisp>)
endif()
