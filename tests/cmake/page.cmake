# Adds tests of the HTML report: the page as text, and in a browser.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
if(TARGET glint)
  foreach(suite Page Compare)
    add_test(NAME cli_Report${suite} COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cli/report_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR} ${suite})
  endforeach()
  add_test(NAME cli_ReportBrowser COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cli/report_browser_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR})
  set_tests_properties(cli_ReportBrowser PROPERTIES SKIP_RETURN_CODE 77)
endif()
