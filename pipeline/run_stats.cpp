// Fills the functional machine's statistics.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/run_stats.h"

namespace glint::pipeline {

FunctionalStats::FunctionalStats(const FunctionalCounts& counts) : Group(nullptr, "gpu") {
  for (size_t c = 0; c < counts.by_class.size(); ++c) {
    instructions_.add(isa::Class(c), counts.by_class[c].instructions);
    lanes_.add(isa::Class(c), counts.by_class[c].lanes);
  }
  rays_ += counts.rays.rays;
  nodes_ += counts.rays.nodes;
  box_tests_ += counts.rays.box_tests;
  triangle_tests_ += counts.rays.triangle_tests;
  for (size_t kind = 0; kind < size_t(exec::FaultKind::Count); ++kind)
    faults_.add(exec::FaultKind(kind), counts.faults.count(exec::FaultKind(kind)));
}

}  // namespace glint::pipeline
