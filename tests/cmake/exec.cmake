# What the executor does to warps and blocks: programs as text, run to their end.
glint_test(unit_exec LINKS glint::pipeline
  SOURCES unit/exec/block_test.cpp unit/exec/atomic_test.cpp unit/exec/call_test.cpp unit/exec/fault_test.cpp unit/exec/address_test.cpp)
