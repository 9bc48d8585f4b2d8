// Runs launches functionally: every effect happens at once. It gives a picture and counts, but no cycles.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "core/cost_recorder.h"
#include "pipeline/render.h"

namespace glint::pipeline {

struct FunctionalCounts {
  std::array<ClassCounts, size_t(isa::Class::Count)> by_class{};
  RayCounts rays;
  exec::FaultLog faults;  // the faults that were let pass
  LaunchEnd end = LaunchEnd::Whole;
  LaunchProgress progress;
  exec::NotFiniteStores not_finite;
};

// Runs a launch. Throws Error(Exit::Fault) when a warp does something wrong, comes into a loop that nothing
// leads out of, or executes more than `instruction_budget` instructions. `listener`, when given, hears of
// every retired instruction, and `costs`, when given, is filled in.
FunctionalCounts run_functional(const exec::World& world, uint64_t instruction_budget,
                                const LaunchWatch& watch, const Probe<exec::Retired>::Listener& listener = {},
                                core::LaunchCosts* costs = nullptr);

// Traverses the rays that `warp` waits for and answers them. Adds what the traversal did to `counts`.
void answer_rays(exec::Executor& executor, exec::WarpContext& warp, RayCounts& counts);

}  // namespace glint::pipeline
