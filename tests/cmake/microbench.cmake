glint_test(timing_op_times LINKS glint::core
  SOURCES timing/op_times_test.cpp ${PROJECT_SOURCE_DIR}/pipeline/engine_loop.cpp ${PROJECT_SOURCE_DIR}/pipeline/cell_pool.cpp)
if(GLINT_ZSTD_INCLUDE AND GLINT_ZSTD)
  glint_test(ptx_h200 FOLDER ptx LINKS glint::pipeline ${GLINT_ZSTD} SOURCES ptx/h200_test.cpp)
  target_include_directories(test_ptx_h200 PRIVATE ${GLINT_ZSTD_INCLUDE})
endif()
