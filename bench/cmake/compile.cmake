add_executable(compile_bench compile_bench.cpp)
target_link_libraries(compile_bench PRIVATE glint::frontend glint_warnings)
target_include_directories(compile_bench PRIVATE ${PROJECT_SOURCE_DIR})
target_compile_definitions(compile_bench PRIVATE GLINT_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
