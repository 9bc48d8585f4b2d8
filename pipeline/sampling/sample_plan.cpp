// Places the segments of a sample.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/sample_plan.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

#include "base/diagnostics.h"
#include "base/split_mix.h"

namespace glint::pipeline {
namespace {

// Choice: more segments see more of the frame, and longer ones keep neighbours together. Both were tried on
// six workloads (docs/sampling.md).
constexpr uint32_t kLeastSegments = 10;
constexpr uint32_t kLeastWaves = 3;  // the first wave starts cold, and what follows it is the steady state
constexpr uint32_t kLeadStep = 2, kRestStep = 8;

// Adds blocks [begin, end) to a stratum, of which one in each `step` is executed.
void add_every(SamplePlan& plan, Stratum stratum, uint32_t begin, uint32_t end, uint32_t step,
               SplitMix& numbers) {
  plan.sizes[size_t(stratum)] += end - begin;
  for (uint32_t first = begin; first < end; first += step)
    if (const uint32_t block = first + numbers.below(step); block < end)
      plan.warm.push_back({block, stratum});
}

// Adds a segment: of each `scale` blocks one is timed.
void add_segment(SamplePlan& plan, uint32_t begin, uint32_t length, SplitMix& numbers) {
  plan.starts.push_back(uint32_t(plan.timed.size()));
  plan.sizes[size_t(Stratum::Inside)] += length * (plan.scale - 1);
  for (uint32_t first = begin; first < begin + length * plan.scale; first += plan.scale) {
    const uint32_t timed = first + numbers.below(plan.scale);
    plan.timed.push_back(timed);
    for (uint32_t block = first; block < first + plan.scale; ++block)
      if (block != timed) plan.warm.push_back({block, Stratum::Inside});
  }
}

}  // namespace

uint32_t largest_scale(const GpuParams& gpu, double share) {
  const uint32_t common = std::gcd(gpu.cores, gpu.memory.dram.channels);
  for (uint32_t scale = common; scale > 1; --scale)
    if (common % scale == 0 && share * scale <= 0.8) return scale;
  return 1;
}

GpuParams cut(const GpuParams& gpu, uint32_t scale) {
  GpuParams part = gpu;
  part.cores /= scale;
  part.memory.dram.channels /= scale;
  part.memory.l2.slice_size *= scale;
  part.core.grid_interval *= scale;
  return part;
}

SamplePlan plan_sample(const SampleOptions& options, uint32_t num_blocks, uint32_t resident, uint32_t scale) {
  const auto num_timed = uint32_t(std::lround(options.share * num_blocks));
  if (num_timed < kLeastWaves * resident)
    throw UserError(
        {},
        fmt::format("a sample of {:g} % has {} of {} blocks, and a part of the machine holds {} at a time",
                    100 * options.share, num_timed, num_blocks, resident),
        fmt::format("a sample needs {} times as many; take a larger share, a larger launch, or all of it",
                    kLeastWaves));
  const uint32_t length = std::max(1u, std::min(resident, num_timed / kLeastSegments)),
                 segments = num_timed / length, span = length * scale;
  SamplePlan plan;
  plan.num_blocks = num_blocks, plan.scale = scale;
  SplitMix numbers(options.seed);
  uint32_t done = 0;  // blocks before this one have a place
  for (uint32_t s = 0; s < segments; ++s) {
    const auto first = uint32_t(uint64_t{num_blocks} * s / segments),
               last = uint32_t(uint64_t{num_blocks} * (s + 1) / segments);
    const uint32_t begin = first + numbers.below(last - first - span + 1);
    const uint32_t lead = std::max(done, begin - std::min(begin, span + span / 2));
    add_every(plan, Stratum::Rest, done, lead, kRestStep, numbers);
    add_every(plan, Stratum::Lead, lead, begin, kLeadStep, numbers);
    add_segment(plan, begin, length, numbers);
    done = begin + span;
  }
  add_every(plan, Stratum::Rest, done, num_blocks, kRestStep, numbers);
  return plan;
}

}  // namespace glint::pipeline
