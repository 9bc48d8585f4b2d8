// Runs a bench: workloads as processes, with their metrics and a summary.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "apps/glint/bench/plan.h"
#include "apps/glint/session.h"

namespace glint::app {

// Runs what the options name into their folder, and prints each workload as it ends. Returns Ok when all
// workloads are complete, and otherwise what went wrong. Throws UserError for options that are impossible.
Exit run_bench(const Session& session, const BenchOptions& options);

}  // namespace glint::app
