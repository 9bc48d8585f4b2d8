add_executable(rtunit_bench rtunit_bench.cpp)
target_link_libraries(rtunit_bench PRIVATE glint::rtunit benchmark::benchmark glint_warnings)
target_include_directories(rtunit_bench PRIVATE ${PROJECT_SOURCE_DIR})
