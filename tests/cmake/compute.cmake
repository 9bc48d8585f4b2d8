if(TARGET glint::pipeline AND TARGET glint::frontend)
  glint_test(compute WITH shaders LINKS test_labs glint::pipeline SOURCES shaders/compute_test.cpp
    shaders/features_test.cpp shaders/image_test.cpp shaders/newer_test.cpp shaders/reconvergence_test.cpp shaders/repairs_test.cpp shaders/subgroup_test.cpp shaders/vendor_test.cpp)
endif()
