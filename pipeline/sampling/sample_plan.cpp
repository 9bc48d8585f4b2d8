// Places the segments of a sample.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/sample_plan.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <numeric>
#include <utility>

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
constexpr uint32_t kSurveyStep = 16;                 // where costs are asked for
constexpr uint32_t kLinesStep = 8, kSurveyed = 512;  // where lines are: so many blocks, and one in 8 at most
// Choice: segments of a grid of several rows are twice as long, because pieces of a row open rows of DRAM
// anew.
constexpr uint32_t kWavesInGrid = 2;
// Lines that many blocks touch matter where they are more than this part of all.
constexpr double kLeastShared = 0.1;

// Names blocks from `begin` up to `end`.
struct Range {
  uint32_t begin = 0, end = 0;
};

// Adds the blocks of one plan in ascending order.
class Planner {
 public:
  // Of the `rows`, which are ascending, all blocks run functionally that are not timed.
  Planner(SamplePlan& plan, const Survey& survey, SplitMix& numbers, std::vector<Range> rows)
      : plan_(plan), survey_(survey), numbers_(numbers), rows_(std::move(rows)) {}

  // Adds the blocks up to `end` to a stratum, of which one in each `step` is executed.
  void add_every(Stratum stratum, uint32_t end, uint32_t step) {
    while (done_ < end) {
      while (next_row_ < rows_.size() && rows_[next_row_].end <= done_) ++next_row_;
      const Range row = next_row_ < rows_.size() ? rows_[next_row_] : Range{end, end};
      if (row.begin <= done_)
        add(Stratum::Inside, std::min(row.end, end), 1);
      else
        add(stratum, std::min(row.begin, end), step);
    }
  }

  // Adds `timed` groups of neighbours, of each of which one is timed.
  void add_timed(uint32_t timed) {
    for (uint32_t i = 0; i < timed; ++i, done_ += plan_.group) {
      uint32_t chosen = done_ + numbers_.below(plan_.group);
      if (survey_.has(chosen) && plan_.group > 1) chosen = chosen > done_ ? chosen - 1 : chosen + 1;
      for (uint32_t block = done_; block < done_ + plan_.group; ++block) {
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

 private:
  void add(Stratum stratum, uint32_t end, uint32_t step) {
    for (uint32_t first = done_; first < end; first += step) {
      uint32_t block = first + numbers_.below(step);
      const uint32_t last = std::min(first + step, end) - 1;
      if (survey_.has(block) && last > first) block = block < last ? block + 1 : block - 1;
      // Where blocks share lines with neighbours alone, those far from a segment do not run, and surveyed
      // blocks stand for them.
      const bool runs = stratum == Stratum::Inside || survey_.is_shared();
      if (runs && block <= last && !survey_.has(block)) plan_.warm.push_back({block, stratum});
      for (uint32_t one = first; one <= last; ++one) ++size_of(one, runs ? stratum : Stratum::Surveyed);
    }
    done_ = end;
  }
  uint32_t& size_of(uint32_t block, Stratum stratum) {
    return plan_.sizes[size_t(survey_.has(block) ? Stratum::Surveyed : stratum)];
  }

  SamplePlan& plan_;
  const Survey& survey_;
  SplitMix& numbers_;
  const std::vector<Range> rows_;
  size_t next_row_ = 0;
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
    for (; next < survey.costs.size() && survey.block(uint32_t(next)) < end; ++next)
      sum += survey.costs[next], ++number;
    out[cell] = number ? sum / number : cell ? out[cell - 1] : 0;
  }
  return out;
}

// Holds numbers of blocks: of a segment, in front of the first one, and behind the last one.
struct SegmentSizes {
  uint32_t front = 0, length = 0, behind = 0;
};

// Returns the blocks of the segments that begin there, or behind the one before, with those in front and
// behind.
std::vector<Range> ranges_of(const std::vector<uint32_t>& begins, const SegmentSizes& sizes,
                             uint32_t num_blocks) {
  std::vector<Range> out;
  auto left = uint32_t(sizes.front + begins.size() * sizes.length + sizes.behind);  // blocks still to place
  uint32_t done = 0;
  for (size_t s = 0; s < begins.size(); ++s) {
    const uint32_t in_front = s == 0 ? sizes.front : 0, after = s + 1 == begins.size() ? sizes.behind : 0,
                   size = in_front + sizes.length + after;
    const uint32_t wanted = begins[s] - std::min(begins[s], in_front);
    const uint32_t begin = std::min(std::max(wanted, done), num_blocks - left);
    out.push_back({begin, begin + size});
    done = begin + size, left -= size;
  }
  return out;
}

// Returns the blocks above those of the segments: they lie `row` blocks earlier.
std::vector<Range> rows_above(const std::vector<Range>& segments, uint32_t row) {
  std::vector<Range> out;
  for (const Range& one : segments)
    if (row > 0 && one.end > row) out.push_back({one.begin - std::min(one.begin, row), one.end - row});
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

GpuParams cut(const GpuParams& gpu, uint32_t scale, double l2_share) {
  GpuParams part = gpu;
  part.cores /= scale;
  part.memory.dram.channels /= scale;
  const uint64_t set = uint64_t{std::max(gpu.memory.l2.ways, 1u)} * gpu.memory.line;
  const double sets = l2_share * double(gpu.memory.l2.slice_size * scale) / double(set);
  part.memory.l2.slice_size = std::max<uint64_t>(1, uint64_t(std::llround(sets))) * set;
  part.core.grid_interval *= scale;
  part.core.cluster_interval *= scale;
  return part;
}

Survey survey_for(const SampleOptions& options, uint32_t blocks_of_lines) {
  if (!(options.share > 0 && options.share <= 0.5))
    throw UserError({}, fmt::format("a sample of {:g} % is out of range", 100 * options.share),
                    "it has more than 0 % and at most 50 % of a launch's blocks");
  const bool needs_costs = way_of(options)->needs_costs();
  if (!blocks_of_lines && !needs_costs) return {};
  const uint32_t step = needs_costs ? kSurveyStep : std::max(kLinesStep, blocks_of_lines / kSurveyed);
  return {.step = step,
          .seed = options.seed,
          .asks = blocks_of_lines ? Question::Lines : Question::Cost,
          .costs = {},
          .shared = {}};
}

uint32_t Survey::block(uint32_t index) const {
  // Blocks at equal distances would lie in few columns of a grid.
  SplitMix numbers(asks == Question::Lines ? seed + 0x9e3779b97f4a7c15ull * (index + 1) : seed);
  return index * step + numbers.below(step);
}

bool Survey::is_shared() const {
  return asks != Question::Lines || double(shared.size()) > kLeastShared * double(lines);
}

std::vector<Address> Survey::fetched_before(double share) const {
  constexpr uint32_t kParts = 1u << 20;
  SplitMix numbers(seed);
  std::vector<Address> out;
  if (!is_shared()) return out;
  for (const Address line : shared)
    if (numbers.below(kParts) >= share * kParts) out.push_back(line);
  return out;
}

std::vector<uint32_t> Survey::left_out_by(const SamplePlan& plan) const {
  std::vector<uint32_t> out;
  for (uint32_t i = 0; i < costs.size(); ++i)
    if (!std::ranges::binary_search(plan.timed, block(i)) &&
        !std::ranges::binary_search(plan.warm, block(i), {}, &WarmBlock::block))
      out.push_back(i);
  return out;
}

SamplePlan plan_sample(const SampleOptions& options, uint32_t num_blocks, uint32_t resident, uint32_t scale,
                       const Survey& survey, uint32_t row) {
  const auto num_timed = uint32_t(std::lround(options.share * num_blocks));
  if (num_timed < kLeastWaves * resident)
    throw UserError(
        {},
        fmt::format("a sample of {:g} % has {} of {} blocks, and a part of the machine holds {} at a time",
                    100 * options.share, num_timed, num_blocks, resident),
        fmt::format("a sample needs {} times as many; take a larger share, a larger launch, or all of it",
                    kLeastWaves));
  const bool has_own_lines = survey.asks == Question::Lines;
  const uint32_t group = has_own_lines ? 1 : scale;
  // A batch begins when the first two waves have started, and then runs mostly what had started half a wave
  // earlier. The last blocks of all run when no batch is open any more.
  const uint32_t filling = resident + resident / 2, behind = resident / 2,
                 rest = num_timed - filling - behind,
                 longest = has_own_lines && row > 0 ? kWavesInGrid * resident : resident,
                 length = std::max(1u, std::min(longest, rest / kLeastSegments)), segments = rest / length;
  SamplePlaces places{num_blocks, segments, length * group, {}};
  if (survey.step) places.costs = costs_of_cells(places, survey);
  SamplePlan plan;
  plan.num_blocks = num_blocks, plan.scale = scale, plan.group = group;
  plan.num_surveyed = has_own_lines ? 0 : uint32_t(survey.costs.size());
  plan.row = has_own_lines ? row : 0;
  SplitMix numbers(options.seed);
  const std::vector<Range> ranges =
      ranges_of(way_of(options)->begins(places, numbers),
                {.front = filling * group, .length = length * group, .behind = behind * group}, num_blocks);
  Planner planner(plan, survey, numbers, group == 1 ? rows_above(ranges, row) : std::vector<Range>{});
  for (uint32_t s = 0; s < segments; ++s) {
    const uint32_t begin = ranges[s].begin, lead = begin - std::min(begin, places.span + places.span / 2),
                   in_front = s == 0 ? filling : 0, after = s + 1 == segments ? behind : 0;
    planner.add_every(Stratum::Rest, lead, kRestStep);
    // What a segment's first block shares with its neighbour would have been fetched by that.
    planner.add_every(Stratum::Lead, begin - std::min(begin, has_own_lines ? 1u : 0u), kLeadStep);
    planner.add_every(Stratum::Inside, begin, 1);
    if (in_front) planner.begin_segment();
    planner.add_timed(in_front);
    planner.begin_segment();
    planner.add_timed(length + after);
  }
  planner.add_every(Stratum::Rest, num_blocks, kRestStep);
  return plan;
}

double footprint_share(const Survey& survey, const SamplePlan& plan, double l2_lines) {
  if (survey.asks != Question::Lines) return 1;
  // Choice: lines that must not leave a cache of several ways need a quarter more than their number.
  const double room = std::min(l2_lines, 1.25 * double(survey.shared.size()));
  const double blocks = double(plan.timed.size() + plan.warm.size()) / plan.num_blocks;
  return (room + std::min(1.0, blocks) * (l2_lines - room)) / l2_lines;
}

}  // namespace glint::pipeline
