// Counts what the frames of a sequence did to the acceleration structures, and how good these were.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "base/stats.h"
#include "pipeline/scene_world.h"

namespace glint::pipeline {

// Holds the statistics of one frame, or of the frames whose trees it has taken in.
class StructureStats : public stats::Group {
 public:
  StructureStats(stats::Group* parent, const StructureWork& work);

 private:
  // Holds the mean over frames of a value of each.
  struct Mean {
    double sum = 0;
    uint32_t frames = 1;
    double value() const { return sum / frames; }
    void take(double other) { sum += other, ++frames; }
  };
  struct Levels : stats::Group {
    Levels(stats::Group* parent, std::string name, const StructureWork::Levels& work);
    stats::Counter built{this, "built", "structure", "Number of structures of this level that were built."};
    stats::Counter refitted{this, "refitted", "structure",
                            "Number of structures of this level that were fitted to what had moved."};
    stats::Counter kept{this, "kept", "structure",
                        "Number of structures of this level in which nothing had moved."};
  };

  Mean visits_mean_, rebuilt_mean_;
  Levels bottom_, top_;
  stats::Value expected_visits_{this,
                                "expected_visits",
                                "node/ray",
                                [this] { return visits_mean_.value(); },
                                "Number of nodes and leaves of all levels that a ray is expected to visit "
                                "which meets the scene's box, by "
                                "the surface-area heuristic. For several frames it is their mean.",
                                [this](double other) { visits_mean_.take(other); }};
  stats::Value expected_visits_rebuilt_{
      this,
      "expected_visits_rebuilt",
      "node/ray",
      [this] { return rebuilt_mean_.value(); },
      "The same number, if all structures had been built for the frame. For several frames it is their mean.",
      [this](double other) { rebuilt_mean_.take(other); }};
};

// Adds the statistics to those of a frame's result.
void add_structure_stats(RenderResult& result, const StructureWork& work);

}  // namespace glint::pipeline
