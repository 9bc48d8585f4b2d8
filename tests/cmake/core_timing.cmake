# Adds tests of cores and their parts, which the engine loop drives.
glint_test(unit_core_timing WITH machine LINKS glint::pipeline
  SOURCES unit/core/alarms_test.cpp unit/core/coalesce_test.cpp unit/core/params_test.cpp unit/core/regrouping_test.cpp unit/core/lsu_test.cpp unit/engine/engine_loop_test.cpp)
glint_test(timing_core WITH machine LINKS glint::pipeline SOURCES timing/core_test.cpp timing/core_limits_test.cpp timing/skip_test.cpp timing/block_test.cpp)
glint_test(contract_issue_scheduler WITH machine LINKS glint::core SOURCES contract/issue_scheduler_test.cpp)
glint_test(contract_reorder WITH machine LINKS glint::core SOURCES contract/reorder_test.cpp)
glint_test(contract_parking WITH machine LINKS glint::core SOURCES contract/parking_test.cpp)
glint_test(contract_interleaving WITH machine LINKS glint::core SOURCES contract/interleaving_test.cpp)
glint_test(contract_warp_layout WITH machine LINKS glint::pipeline SOURCES contract/warp_layout_test.cpp)
glint_test(timing_hazards WITH machine LINKS glint::pipeline SOURCES timing/hazard_test.cpp)
glint_test(timing_code WITH machine LINKS glint::pipeline SOURCES timing/code_cache_test.cpp timing/core_code_test.cpp)
glint_test(timing_texture_unit WITH machine LINKS glint::pipeline SOURCES timing/texture_unit_test.cpp)
glint_test(timing_machine WITH machine LINKS glint::pipeline SOURCES timing/whole_machine_test.cpp)
