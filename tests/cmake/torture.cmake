# Adds tests that run random programs against a scalar interpreter of SPIR-V.
if(TARGET glint::pipeline AND TARGET glint::frontend)
  add_library(glint_torture STATIC torture/interpreter.cpp torture/interpreter_glsl.cpp torture/interpreter_ops.cpp torture/interpreter_run.cpp
    torture/expressions.cpp torture/function_writer.cpp torture/generator.cpp torture/machines.cpp torture/tree_glsl.cpp torture/tree_spirv.cpp)
  target_link_libraries(glint_torture PUBLIC glint::pipeline PRIVATE glint_warnings)
  target_include_directories(glint_torture PUBLIC ${PROJECT_SOURCE_DIR})
  target_precompile_headers(glint_torture REUSE_FROM glint_base)
  glint_cold(glint_torture -O2 12)
  set_source_files_properties(torture/interpreter_run.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)  # A class of a header has a member of its anonymous namespace.
  set_source_files_properties(torture/interpreter.cpp PROPERTIES COMPILE_DEFINITIONS SPV_ENABLE_UTILITY_CODE)
  glint_test(torture LINKS glint_torture)
endif()
