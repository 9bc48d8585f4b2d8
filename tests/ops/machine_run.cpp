// Chooses the machine and listens to what retires.
// SPDX-License-Identifier: Apache-2.0
#include "tests/ops/machine_run.h"

#include <bit>

#include "pipeline/functional_machine.h"
#include "pipeline/timing_machine.h"

namespace glint::test {

void run_machine(const exec::World& world, Machine which, uint64_t instruction_budget,
                 const isa::OpRow& counted, uint64_t& lanes) {
  const auto listen = [&](const exec::Retired& retired) {
    if (retired.issued.row == &counted) lanes += uint64_t(std::popcount(retired.issued.lanes));
  };
  if (which == Machine::Functional) {
    pipeline::run_functional(world, instruction_budget, {}, listen);
    return;
  }
  pipeline::GpuParams gpu;
  gpu.cores = which == Machine::Sorting ? 1 : 2;
  if (which == Machine::Sorting) gpu.core.reorder = PolicyChoice<core::Reorder>("sort");
  pipeline::TimingMachine machine(gpu, world, false);
  for (uint32_t c = 0; c < machine.num_cores(); ++c) machine.core(c).executor().retired.listen(listen);
  machine.run({});
}

}  // namespace glint::test
