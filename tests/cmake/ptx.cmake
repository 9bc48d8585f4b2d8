find_package(nlohmann_json REQUIRED)
glint_test(isa_golden WITH ptx FOLDER isa/golden LINKS glint::pipeline nlohmann_json::nlohmann_json ${GLINT_ZSTD}
  SOURCES isa/golden/golden_test.cpp isa/golden/tensor_golden_test.cpp isa/golden/recording.cpp)
target_include_directories(${GLINT_TEST_PROGRAM} PRIVATE ${GLINT_ZSTD_INCLUDE})
glint_test(ptx_calibration WITH ptx FOLDER ptx LINKS glint::pipeline ${GLINT_ZSTD} SOURCES ptx/calibration_test.cpp)
target_include_directories(${GLINT_TEST_PROGRAM} PRIVATE ${GLINT_ZSTD_INCLUDE})
glint_test(ptx WITH ptx LINKS glint::pipeline SOURCES ptx/assembler_test.cpp ptx/async_test.cpp ptx/blocks_test.cpp ptx/calls_test.cpp ptx/control_test.cpp ptx/fusion_test.cpp
  ptx/narrowing_test.cpp ptx/ptx_test.cpp ptx/reconvergence_test.cpp ptx/runtime_test.cpp ptx/shape_test.cpp ptx/tensor_test.cpp ptx/textures_test.cpp ptx/types_test.cpp ptx/video_test.cpp ptx/waiting_test.cpp)
find_package(Python3 REQUIRED COMPONENTS Interpreter)
if(TARGET glint)
  add_test(NAME cli_kernels COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cli/kernel_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR})
endif()
