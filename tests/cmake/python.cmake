# Adds tests of the Python package: reader, figures, notebook, and its installation by `cmake --install`.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
if(TARGET glint)
  foreach(part reader damage sweep plot layout notebook)
    add_test(NAME python_${part} COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/python/${part}_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR})
  endforeach()
  add_test(NAME python_install COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/python/install_test.py ${CMAKE_COMMAND} ${PROJECT_BINARY_DIR})
  set_tests_properties(python_plot python_layout python_notebook PROPERTIES SKIP_RETURN_CODE 77)
endif()
