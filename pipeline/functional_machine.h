// The functional machine: block after block, the warps of a block in turns, every effect at once. A picture
// and counts, no cycles.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>

#include "core/cost_recorder.h"
#include "pipeline/render.h"

namespace glint::pipeline {

struct FunctionalCounts {
  std::array<ClassCounts, size_t(isa::Class::Count)> by_class{};
  RayCounts rays;
  exec::FaultLog faults;  // that were let pass
};

// Error(Exit::Fault) when a warp does something wrong or executes more than `instruction_budget`
// instructions. `listener`, when given, hears of every retired instruction; `costs` is filled in.
FunctionalCounts run_functional(const exec::World& world, uint64_t instruction_budget,
                                const std::function<void(uint64_t done, uint64_t total)>& progress,
                                const Probe<exec::Retired>::Listener& listener = {},
                                core::LaunchCosts* costs = nullptr);

// Traverses the rays that `warp` waits for and answers them. Adds to `counts` what the traversal did.
void answer_rays(exec::Executor& executor, exec::WarpContext& warp, RayCounts& counts);

}  // namespace glint::pipeline
