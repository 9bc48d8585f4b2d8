if(TARGET glint::pipeline AND TARGET glint::frontend)
  glint_test(shaders WITH shaders LINKS test_labs glint::pipeline SOURCES shaders/binding_table_test.cpp shaders/language_test.cpp shaders/numbers_test.cpp
    shaders/query_test.cpp shaders/ray_features_test.cpp shaders/ray_traps_test.cpp shaders/refusal_test.cpp shaders/tracing_test.cpp shaders/widths_test.cpp)
endif()
