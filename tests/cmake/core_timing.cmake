# The engine loop is compiled in, so that these tests do not need the whole pipeline.
set(engine_loop ${PROJECT_SOURCE_DIR}/pipeline/engine_loop.cpp ${PROJECT_SOURCE_DIR}/pipeline/cell_pool.cpp)
glint_test(unit_core_timing LINKS glint::core
  SOURCES unit/core/coalesce_test.cpp unit/core/params_test.cpp unit/core/lsu_test.cpp unit/core/engine_loop_test.cpp ${engine_loop})
glint_test(timing_core LINKS glint::core SOURCES timing/core_test.cpp timing/block_test.cpp ${engine_loop})
glint_test(contract_issue_scheduler LINKS glint::core SOURCES contract/issue_scheduler_test.cpp)
