if(TARGET glint::pipeline AND TARGET glint::frontend)
  glint_test(references WITH shaders LINKS test_labs glint::pipeline SOURCES shaders/references_test.cpp)
endif()
