# Adds tests of the documentation: every command and program in it runs, its figures are those of its tables, and the
# site is built from it.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME docs_Figures COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tools/draw_validation.py --check)
if(TARGET glint)
  foreach(suite Commands Programs Inline Policy Files Harness)
    add_test(NAME docs_${suite} COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs/docs_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR} ${suite})
  endforeach()
  add_test(NAME docs_site COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs/site_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR})
  set_tests_properties(docs_Programs docs_Policy docs_site PROPERTIES SKIP_RETURN_CODE 77)
endif()
