if(TARGET glint::pipeline AND TARGET glint::frontend)
  glint_test(references LINKS glint::pipeline SOURCES shaders/compute_lab.cpp shaders/ray_lab.cpp shaders/references_test.cpp)
endif()
