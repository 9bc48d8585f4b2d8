// Interface: chooses where the segments of a sample lie (`--sample-by`).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "base/registry.h"
#include "base/split_mix.h"

namespace glint::pipeline {

// Says what is to be placed. The launch is also cut into cells, which are as long as a segment or a little
// longer; there are more of them than segments.
struct SamplePlaces {
  uint32_t num_blocks = 0;  // of the launch
  uint32_t segments = 0;    // how many there are
  uint32_t span = 1;        // blocks from the first to the last one of a segment, timed or not
  // What the blocks of each cell cost in the mean, by a functional run of some of them; empty unless the way
  // asks for it.
  std::vector<double> costs;

  uint32_t num_cells() const { return num_blocks / span; }
  uint32_t cell_begin(uint32_t cell) const { return uint32_t(uint64_t{num_blocks} * cell / num_cells()); }
};

// Contract (tests/contract/sample_way_test.cpp):
//  - begins() returns a place for each segment, ascending, from which the segment fits into the launch.
//  - Equal places and numbers give equal answers, and every cell may get a segment with some seed.
class SampleWay {
 public:
  static constexpr PolicyKind kKind{"(--sample-by)", "pipeline/sampling/ways"};
  struct Context {};

  virtual ~SampleWay() = default;
  // Returns whether begins() needs to know what cells cost.
  virtual bool needs_costs() const { return false; }
  // Returns the first block of each segment. Segments may overlap; plan_sample() moves the later ones.
  virtual std::vector<uint32_t> begins(const SamplePlaces& places, SplitMix& numbers) const = 0;
};

// Returns the first blocks of cells, ascending.
std::vector<uint32_t> begins_of(const SamplePlaces& places, std::vector<uint32_t> cells);

// Returns the cells from the cheapest to the dearest; those that cost the same are in order.
std::vector<uint32_t> cells_by_cost(const SamplePlaces& places);

}  // namespace glint::pipeline
