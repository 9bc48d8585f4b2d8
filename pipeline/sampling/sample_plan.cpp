// Places the segments of a sample.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/sample_plan.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <numeric>

#include "base/diagnostics.h"
#include "base/split_mix.h"
#include "pipeline/sampling/sample_way.h"

namespace glint::pipeline {
namespace {

// Choice: more segments see more of the frame, and longer ones keep neighbours together. Both were tried on
// six workloads (docs/sampling.md).
constexpr uint32_t kLeastSegments = 10;
constexpr uint32_t kLeastWaves = 3;  // the first two start cold, and what follows them is the steady state
// Choice: of the blocks in front of a segment, and of all others, one in so many runs functionally.
constexpr uint32_t kLeadStep = 3, kRestStep = 12;
constexpr uint32_t kSurveyStep = 16;

// Adds the blocks of one plan in ascending order.
class Planner {
 public:
  Planner(SamplePlan& plan, const Survey& survey, SplitMix& numbers)
      : plan_(plan), survey_(survey), numbers_(numbers) {}

  // Adds the blocks up to `end` to a stratum, of which one in each `step` is executed.
  void add_every(Stratum stratum, uint32_t end, uint32_t step) {
    for (uint32_t first = done_; first < end; first += step) {
      uint32_t block = first + numbers_.below(step);
      const uint32_t last = std::min(first + step, end) - 1;
      if (survey_.has(block) && last > first) block = block < last ? block + 1 : block - 1;
      if (block <= last && !survey_.has(block)) plan_.warm.push_back({block, stratum});
      for (uint32_t one = first; one <= last; ++one) ++size_of(one, stratum);
    }
    done_ = std::max(done_, end);
  }

  // Adds `timed` groups of `scale` neighbours, of each of which one is timed.
  void add_timed(uint32_t timed) {
    for (uint32_t i = 0; i < timed; ++i, done_ += plan_.scale) {
      uint32_t chosen = done_ + numbers_.below(plan_.scale);
      if (survey_.has(chosen) && plan_.scale > 1) chosen = chosen > done_ ? chosen - 1 : chosen + 1;
      for (uint32_t block = done_; block < done_ + plan_.scale; ++block) {
        if (block == chosen && !survey_.has(block)) {
          plan_.timed.push_back(block);
          continue;
        }
        ++size_of(block, Stratum::Inside);
        if (!survey_.has(block)) plan_.warm.push_back({block, Stratum::Inside});
      }
    }
  }
  void begin_segment() { plan_.starts.push_back(uint32_t(plan_.timed.size())); }
  uint32_t done() const { return done_; }

 private:
  uint32_t& size_of(uint32_t block, Stratum stratum) {
    return plan_.sizes[size_t(survey_.has(block) ? Stratum::Surveyed : stratum)];
  }

  SamplePlan& plan_;
  const Survey& survey_;
  SplitMix& numbers_;
  uint32_t done_ = 0;  // blocks before this one have a place
};

// Returns the mean costs of the cells' surveyed blocks. A cell without any costs what the one before it does.
std::vector<double> costs_of_cells(const SamplePlaces& places, const Survey& survey) {
  std::vector<double> out(places.num_cells());
  size_t next = 0;
  for (uint32_t cell = 0; cell < out.size(); ++cell) {
    const uint32_t end = cell + 1 < out.size() ? places.cell_begin(cell + 1) : places.num_blocks;
    double sum = 0;
    uint32_t number = 0;
    for (; next < survey.costs.size() && survey.first + next * survey.step < end; ++next)
      sum += survey.costs[next], ++number;
    out[cell] = number ? sum / number : cell ? out[cell - 1] : 0;
  }
  return out;
}

std::unique_ptr<SampleWay> way_of(const SampleOptions& options) {
  return PolicyChoice<SampleWay>(options.by.c_str()).make({});
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

Survey survey_for(const SampleOptions& options) {
  if (!(options.share > 0 && options.share <= 0.5))
    throw UserError({}, fmt::format("a sample of {:g} % is out of range", 100 * options.share),
                    "it has more than 0 % and at most 50 % of a launch's blocks");
  if (!way_of(options)->needs_costs()) return {};
  SplitMix numbers(options.seed);
  return {kSurveyStep, numbers.below(kSurveyStep), {}};
}

SamplePlan plan_sample(const SampleOptions& options, uint32_t num_blocks, uint32_t resident, uint32_t scale,
                       const Survey& survey) {
  const auto num_timed = uint32_t(std::lround(options.share * num_blocks));
  if (num_timed < kLeastWaves * resident)
    throw UserError(
        {},
        fmt::format("a sample of {:g} % has {} of {} blocks, and a part of the machine holds {} at a time",
                    100 * options.share, num_timed, num_blocks, resident),
        fmt::format("a sample needs {} times as many; take a larger share, a larger launch, or all of it",
                    kLeastWaves));
  // A batch begins when the first two waves have started, and then runs mostly what had started half a wave
  // earlier. The last blocks of all run when no batch is open any more.
  const uint32_t filling = resident + resident / 2, behind = resident / 2,
                 rest = num_timed - filling - behind,
                 length = std::max(1u, std::min(resident, rest / kLeastSegments)), segments = rest / length;
  SamplePlaces places{num_blocks, segments, length * scale, {}};
  if (survey.step) places.costs = costs_of_cells(places, survey);
  SamplePlan plan;
  plan.num_blocks = num_blocks, plan.scale = scale;
  SplitMix numbers(options.seed);
  const std::vector<uint32_t> begins = way_of(options)->begins(places, numbers);
  Planner planner(plan, survey, numbers);
  uint32_t left = (filling + segments * length + behind) * scale;  // blocks of the segments to come
  for (uint32_t s = 0; s < segments; ++s) {
    const uint32_t in_front = s == 0 ? filling : 0, after = s + 1 == segments ? behind : 0;
    const uint32_t wanted = begins[s] - std::min(begins[s], in_front * scale);
    const uint32_t begin = std::min(std::max(wanted, planner.done()), num_blocks - left);
    const uint32_t lead = begin - std::min(begin, places.span + places.span / 2);
    planner.add_every(Stratum::Rest, lead, kRestStep);
    planner.add_every(Stratum::Lead, begin, kLeadStep);
    if (in_front) planner.begin_segment();
    planner.add_timed(in_front);
    planner.begin_segment();
    planner.add_timed(length + after);
    left -= (in_front + length + after) * scale;
  }
  planner.add_every(Stratum::Rest, num_blocks, kRestStep);
  return plan;
}

}  // namespace glint::pipeline
