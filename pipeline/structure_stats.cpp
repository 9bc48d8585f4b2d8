// Counts what frames did to the acceleration structures.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/structure_stats.h"

#include <memory>
#include <utility>

#include "pipeline/run_stats.h"

namespace glint::pipeline {

StructureStats::Levels::Levels(stats::Group* parent, std::string name, const StructureWork::Levels& work)
    : Group(parent, std::move(name)) {
  built += work.built, refitted += work.refitted, kept += work.kept;
}

StructureStats::StructureStats(stats::Group* parent, const StructureWork& work)
    : Group(parent, "structures"),
      visits_mean_{work.expected_visits},
      rebuilt_mean_{work.expected_visits_rebuilt},
      bottom_(this, "bottom_levels", work.bottom),
      top_(this, "top_level", work.top) {
}

void add_structure_stats(RenderResult& result, const StructureWork& work) {
  result.stats->keep(std::make_unique<StructureStats>(&result.stats->root(), work));
}

}  // namespace glint::pipeline
