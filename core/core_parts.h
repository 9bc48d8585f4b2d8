// Holds what the units of a core have in common.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/core_counts.h"
#include "core/core_observer.h"
#include "core/issue_table.h"
#include "core/params.h"
#include "core/warp_slots.h"
#include "exec/executor.h"

namespace glint::core {

// Every unit holds a copy of these references. Everything else that a unit knows is its own, and no unit
// reads the state of another.
struct CoreParts {
  const Params& params;
  const exec::World& world;
  const IssueTable& table;
  exec::Executor& executor;
  WarpSlots& warps;
  CoreCounts& counts;
  const CoreObservers& observers;
};

}  // namespace glint::core
