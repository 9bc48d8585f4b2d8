// Chooses the blocks of a launch that a sampled run times, and those that it runs functionally.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/params.h"

namespace glint::pipeline {

struct SampleOptions {
  double share = 0.05;          // the share of a launch's blocks that is timed: more than 0, at most a half
  uint64_t seed = 1;            // selects which
  std::string by = "position";  // the SampleWay that places the segments
};

// Names where a block that is not timed lies: within a segment or above it, in front of one, or elsewhere.
// What surveyed blocks cost was asked for before the plan was made, so they have run already. Where blocks
// that lie far apart share no lines, surveyed blocks stand for all that lie elsewhere.
enum class Stratum : uint8_t { Inside, Lead, Rest, Surveyed, Count };

// Names a block that runs functionally.
struct WarmBlock {
  uint32_t block = 0;
  Stratum stratum = Stratum::Inside;
};

// The machine is cut to 1/scale of its cores and memory partitions, and the sample consists of segments. A
// segment is a run of neighbouring blocks, of which the small machine runs one in `scale`: as many as its
// cores would get of them if it were whole. The other cores' blocks run functionally and leave what they
// touch in the L2. So neighbours meet in the caches as they do in a whole run, which they do not when the
// timed blocks are spread evenly. Of a launch whose lines were asked for, the small machine runs all blocks
// of a segment: what only neighbours share would otherwise be there already, since those that run
// functionally are done before the timed ones begin. Of such a launch the block in front of a segment and
// those of the row above it run functionally, and others do not unless blocks that lie far apart share lines,
// too. Of all other launches, a share of the blocks in front of a segment and of all others run functionally:
// for the L2, and to estimate the work of the whole launch. The first segment has blocks in front that fill
// the machine, and the last one has blocks behind it that keep the machine full, so that each segment is
// measured on a full machine.
struct SamplePlan {
  uint32_t num_blocks = 0;       // of the launch
  uint32_t scale = 1;            // the part of the machine that runs them is 1/scale
  uint32_t group = 1;            // one of so many neighbours of a segment is timed
  std::vector<uint32_t> timed;   // ascending
  std::vector<uint32_t> starts;  // indices into `timed` at which segments begin; the first is 0
  std::vector<WarmBlock> warm;   // ascending
  // These are the numbers of blocks that are not timed, executed or not, by stratum.
  std::array<uint32_t, size_t(Stratum::Count)> sizes{};
  uint32_t num_surveyed = 0;  // blocks that have run for good before the plan was made
  uint32_t row = 0;           // blocks in a row of the grid, or 0 where it is of no matter
  // Returns how many blocks run functionally, and leave what they write.
  uint64_t num_functional() const { return num_surveyed + warm.size(); }
};

// Returns the largest part 1/n that the machine can be cut to: n divides the numbers of cores and of memory
// partitions, and a part still has room for `share` of the blocks.
uint32_t largest_scale(const GpuParams& gpu, double share);

// Returns the machine cut to 1/scale, with `l2_share` of the whole L2. Data that all blocks share are not
// fewer in a sample, and data that each block has for itself are (footprint_share()).
GpuParams cut(const GpuParams& gpu, uint32_t scale, double l2_share = 1);

// Says what is asked of some of a launch's blocks before others run: nothing, what they cost, or also which
// lines of memory they touch.
enum class Question : uint8_t { None, Cost, Lines };

// Holds what some of a launch's blocks do: every n-th one, or none where nothing is asked.
struct Survey {
  uint32_t step = 0;  // it has one of so many neighbouring blocks; 0: it has none
  uint64_t seed = 0;  // selects which
  Question asks = Question::None;
  std::vector<double> costs;    // of these blocks
  uint64_t lines = 0;           // of memory, that any of them touches
  std::vector<Address> shared;  // those that many of them touch, ascending
  // Returns one of its blocks, which are ascending. The last one may lie behind the launch.
  uint32_t block(uint32_t index) const;
  // Says whether a block has run for good. Blocks whose lines were asked for have left nothing behind.
  bool has(uint32_t block) const {
    return step > 0 && asks != Question::Lines && this->block(block / step) == block;
  }
  // Says whether blocks that are far from each other have lines in common that matter.
  bool is_shared() const;
  // Returns those of its shared lines that the L2 holds when a sample of this share of a launch begins. The
  // launch fetches each of them once, and the sample its share of them.
  std::vector<Address> fetched_before(double share) const;
  // Returns those of its blocks that a plan neither times nor runs, by their index. They stand for all such
  // blocks, and others would not, since a plan times more blocks at the ends of a launch than elsewhere.
  std::vector<uint32_t> left_out_by(const SamplePlan& plan) const;
};

// Returns which blocks have to be surveyed. What they do is still missing. Lines are asked for of a launch of
// `blocks_of_lines`, unless that is 0, and otherwise costs, when the way of choosing needs them. Throws
// UserError for a share that is out of range.
Survey survey_for(const SampleOptions& options, uint32_t blocks_of_lines = 0);

// Makes the plan for a launch of `num_blocks` of which the cut machine holds `resident` at a time. The grid
// has `row` blocks in a row, or one row when it is 0. Equal arguments give equal plans. Throws UserError for
// a share that is too small for the launch.
SamplePlan plan_sample(const SampleOptions& options, uint32_t num_blocks, uint32_t resident, uint32_t scale,
                       const Survey& survey = {}, uint32_t row = 0);

// Returns which share of an L2 of `l2_lines` the part's L2 has: room for all lines that many blocks touch,
// and of the rest the share of the launch's blocks that run on the part or for its L2. So it fills with what
// each block has for itself as early in the sample as in the whole launch, and what all blocks read stays in
// it as it does there. It is 1 where lines were not asked for.
double footprint_share(const Survey& survey, const SamplePlan& plan, double l2_lines);

}  // namespace glint::pipeline
