add_executable(render_bench render_bench.cpp)
target_link_libraries(render_bench PRIVATE glint::pipeline benchmark::benchmark glint_warnings)
target_include_directories(render_bench PRIVATE ${PROJECT_SOURCE_DIR})
target_compile_definitions(render_bench PRIVATE GLINT_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
