add_executable(launches_bench launches_bench.cpp)
target_link_libraries(launches_bench PRIVATE glint::pipeline benchmark::benchmark glint_warnings)
target_include_directories(launches_bench PRIVATE ${PROJECT_SOURCE_DIR})
target_compile_definitions(launches_bench PRIVATE GLINT_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
