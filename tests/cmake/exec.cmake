# Adds tests of what the executor does to warps and blocks, with programs as text that run to their end.
glint_test(unit_exec WITH shaders LINKS glint::pipeline
  SOURCES unit/exec/block_test.cpp unit/exec/atomic_test.cpp unit/exec/call_test.cpp unit/exec/fault_test.cpp unit/exec/address_test.cpp unit/exec/endless_loops_test.cpp unit/exec/simt_stack_test.cpp
  unit/exec/block_memory_test.cpp)
