add_executable(memsys_bench memsys_bench.cpp)
target_link_libraries(memsys_bench PRIVATE glint::memsys benchmark::benchmark glint_warnings)
target_include_directories(memsys_bench PRIVATE ${PROJECT_SOURCE_DIR})
