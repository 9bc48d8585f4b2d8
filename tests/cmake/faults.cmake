if(TARGET glint::pipeline AND TARGET glint::frontend)
  glint_test(faults WITH shaders LINKS test_labs glint::pipeline SOURCES faults/faults.cpp faults/log_test.cpp faults/memory_test.cpp faults/rays_test.cpp)
endif()
