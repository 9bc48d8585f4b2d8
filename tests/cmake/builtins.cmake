find_path(GLINT_ZSTD_INCLUDE zstd.h)
find_library(GLINT_ZSTD zstd)
if(TARGET glint::pipeline AND TARGET glint::frontend AND GLINT_ZSTD_INCLUDE AND GLINT_ZSTD)
  glint_test(builtins LINKS glint::pipeline glint::frontend ${GLINT_ZSTD}
    SOURCES shaders/builtins_test.cpp shaders/builtin_reference.cpp)
  target_include_directories(test_builtins PRIVATE ${GLINT_ZSTD_INCLUDE})
elseif(NOT GLINT_ZSTD_INCLUDE OR NOT GLINT_ZSTD)
  message(STATUS "Test builtins is left out: libzstd-dev is not installed")
endif()
