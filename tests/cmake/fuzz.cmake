# Adds tests that replay the inputs that fuzzers have kept, and with -DGLINT_FUZZ=ON the fuzzers (tests/fuzz/README.md).
if(TARGET glint::core)
  # Only the machine is linked, because the rest of the pipeline compiles shaders, which no fuzzer here does.
  set(fuzz_sources ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/entry.cpp ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/program_of.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/tiny_world.cpp ${PROJECT_SOURCE_DIR}/pipeline/functional_machine.cpp
    ${PROJECT_SOURCE_DIR}/pipeline/block_runner.cpp ${PROJECT_SOURCE_DIR}/pipeline/blocks_ahead.cpp)
  glint_test(fuzz LINKS glint::core SOURCES fuzz/replay_test.cpp ${fuzz_sources})
  if(GLINT_FUZZ)
    foreach(fuzzer asm_fuzz verify_fuzz)
      add_executable(${fuzzer} fuzz/${fuzzer}.cpp ${fuzz_sources})
      target_link_libraries(${fuzzer} PRIVATE glint::core glint_warnings)
      target_include_directories(${fuzzer} PRIVATE ${PROJECT_SOURCE_DIR})
      target_link_options(${fuzzer} PRIVATE -fsanitize=fuzzer)
    endforeach()
  endif()
endif()
