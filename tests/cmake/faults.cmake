if(TARGET glint::pipeline AND TARGET glint::frontend)
  glint_test(faults LINKS glint::pipeline SOURCES faults/faults.cpp faults/log_test.cpp faults/memory_test.cpp faults/rays_test.cpp shaders/compute_lab.cpp
    shaders/ray_lab.cpp)
endif()
