find_package(CLI11 REQUIRED)
add_executable(isa_bench isa_bench.cpp)
target_link_libraries(isa_bench PRIVATE glint::isa CLI11::CLI11 glint_warnings)
target_include_directories(isa_bench PRIVATE ${PROJECT_SOURCE_DIR})
