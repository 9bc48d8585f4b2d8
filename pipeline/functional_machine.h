// Runs launches functionally: every effect happens at once. It gives a picture and counts, but no cycles.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>

#include "core/cost_recorder.h"
#include "pipeline/block_runner.h"
#include "pipeline/render.h"

namespace glint::pipeline {

struct FunctionalCounts : WorkCounts {
  exec::FaultLog faults;  // the faults that were let pass
  LaunchEnd end = LaunchEnd::Whole;
  LaunchProgress progress;
  exec::NotFiniteStores not_finite;
};

// Runs a launch block by block. Throws Error(Exit::Fault) when a warp does something wrong, comes into a loop
// that nothing leads out of, or executes more than `instruction_budget` instructions. `listener`, when given,
// hears of every retired instruction, and `costs`, when given, is filled in. With several `threads` of the
// host (0: one for each processor) blocks run before their turn, with the results of running in order; a
// launch that is listened to, that has costs or prints runs on one thread.
FunctionalCounts run_functional(const exec::World& world, uint64_t instruction_budget,
                                const LaunchWatch& watch, const Probe<exec::Retired>::Listener& listener = {},
                                core::LaunchCosts* costs = nullptr, uint32_t threads = 1);

// Hears of all that the blocks of a launch do.
struct LaunchListener {
  std::function<void(exec::Executor&)> begin;  // gets the executor before the first block starts
  BlockRunner::NodeListener nodes;             // hears of nodes that rays visit, unless it is empty
};

// Does the same on one thread, and tells the listener.
FunctionalCounts run_functional_heard(const exec::World& world, uint64_t instruction_budget,
                                      const LaunchWatch& watch, const LaunchListener& listener);

}  // namespace glint::pipeline
