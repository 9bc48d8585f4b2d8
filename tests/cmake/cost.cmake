# Adds tests of maps of cost and traces.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
if(TARGET glint)
  foreach(suite Heat Trace Report Browser)
    add_test(NAME cli_Cost${suite} COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cli/cost_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR} ${suite})
  endforeach()
  set_tests_properties(cli_CostBrowser PROPERTIES SKIP_RETURN_CODE 77)
endif()
