glint_test(threads WITH machine LINKS glint::pipeline
  SOURCES threads/cell_pool_test.cpp threads/machine_test.cpp threads/memory_view_test.cpp)
glint_test(threads_mechanisms WITH machine LINKS glint::pipeline SOURCES threads/mechanisms_test.cpp)
find_package(Python3 REQUIRED COMPONENTS Interpreter)
if(TARGET glint)
  foreach(suite threads stuck impossible microbench)
    add_test(NAME cli_${suite}
      COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cli/${suite}_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR})
  endforeach()
endif()
