# Adds tests of where the time goes: profiles, time series, conservation, machines that are stuck.
glint_test(timing_profile WITH machine LINKS glint::pipeline SOURCES timing/profile_test.cpp)
find_package(Python3 REQUIRED COMPONENTS Interpreter)
if(TARGET glint)
  add_test(NAME cli_Profile COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cli/profile_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR})
endif()
