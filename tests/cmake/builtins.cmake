if(TARGET glint::pipeline AND TARGET glint::frontend)
  glint_test(builtins LINKS glint::pipeline glint::frontend ${GLINT_ZSTD}
    SOURCES shaders/builtins_test.cpp shaders/builtin_reference.cpp)
  target_include_directories(test_builtins PRIVATE ${GLINT_ZSTD_INCLUDE})
endif()
