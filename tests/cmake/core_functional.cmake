# What the functional side of blocks does: programs as text, run to their end.
glint_test(unit_core_functional LINKS glint::pipeline
  SOURCES unit/core/block_test.cpp unit/core/atomic_test.cpp unit/core/call_test.cpp unit/core/fault_test.cpp unit/core/address_test.cpp)
