// Runs a sample and reads the machine's counters between its segments.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/sampled_run.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <fmt/format.h>
#include <memory>
#include <span>
#include <utility>

#include "base/diagnostics.h"
#include "core/core_cell.h"
#include "pipeline/launch_part.h"
#include "pipeline/run_stats.h"
#include "pipeline/sampling/survey.h"
#include "pipeline/sampling/warmer.h"
#include "pipeline/scene_world.h"
#include "pipeline/timing_machine.h"

namespace glint::pipeline {
namespace {

// Returns what the L2 has asked of DRAM, and what it would still have to write.
DramTraffic traffic_of(const TimingMachine& machine, uint64_t unwritten_sectors) {
  const mem::Params& params = machine.params().memory;
  const double atom = std::max(params.dram.atom_bytes(), mem::kSectorBytes);
  DramTraffic out;
  out.clocks = double(params.dram.burst) / params.dram.transfers_per_clock *
               std::max(1.0, double(mem::kSectorBytes) / params.dram.atom_bytes());
  out.unwritten = double(unwritten_sectors) * mem::kSectorBytes / atom;
  for (uint32_t i = 0; i < machine.memory().num_partitions(); ++i) {
    const mem::Partition& partition = machine.memory().partition(i);
    for (uint32_t slice = 0; slice < partition.num_slices(); ++slice) {
      out.reads += double(partition.slice(slice).stats().dram_reads.value());
      out.writes += double(partition.slice(slice).stats().dram_writes.value());
      out.l2 += double(params.l2.slice_size) / atom;
    }
  }
  return out;
}

// Runs the untimed blocks before the timed ones behind them start, and closes a batch where a segment begins.
class Sampler final : public LaunchPart {
 public:
  Sampler(const SamplePlan& plan, TimingMachine& machine, const exec::World& world,
          std::vector<BlockWork> surveyed, mem::Displaced displaced, bool is_shared)
      : plan_(plan),
        machine_(machine),
        displaced_(displaced),
        is_shared_(is_shared),
        warmer_(
            world, machine.params().core.instruction_budget, machine.params().memory,
            [this](Address line, uint8_t sectors, mem::Touch touch) {
              return machine_.memory().warm(line, sectors, touch, fate());
            },
            Written::AsRead) {
    work_[size_t(Stratum::Surveyed)] = std::move(surveyed);
  }

  std::span<const uint32_t> blocks() const override { return plan_.timed; }

  void before_start(Cycle now, uint32_t started) override {
    if (started < plan_.timed.size()) warm(plan_.timed[started]);
    if (started == last_started_) return;
    last_started_ = started;
    if (first_wave_ == 0) first_wave_ = started;
    // The second wave ends what is left of the cold start.
    if (!is_full_ && started >= 2 * first_wave_) is_full_ = true, mark_ = counts_of(machine_, now);
    if (!is_half_done_ && 2 * started >= plan_.timed.size()) {
      is_half_done_ = true;
      half_ = counts_of(machine_, now), traffic_of_half_ = traffic();
    }
    while (next_start_ < plan_.starts.size() && plan_.starts[next_start_] <= started) ++next_start_;
    const bool ends = started == plan_.timed.size(), begins = next_start_ > segment_;
    if (is_full_ && (ends || begins)) close_batch(now, started);
    segment_ = next_start_;
  }

  // Returns what a run of `cycles` has counted, after running what is left of the untimed blocks.
  SampleCounts finish(Cycle cycles);
  const exec::FaultLog& passed() const { return warmer_.passed(); }

 private:
  void warm(uint32_t until) {
    for (; next_warm_ < plan_.warm.size() && plan_.warm[next_warm_].block < until; ++next_warm_) {
      stratum_ = plan_.warm[next_warm_].stratum;
      const WorkCounts counts = warmer_.run(plan_.warm[next_warm_].block);
      work_[size_t(stratum_)].push_back({counts.instructions(), counts.rays.nodes});
    }
  }
  // Returns what becomes of dirty lines that make way for those of the block that runs functionally. Where
  // other parts share the L2, blocks of a segment take places as those of other parts would. All other blocks
  // come at once, between two segments, and would push out stacks that are in use.
  mem::Displaced fate() const {
    return is_shared_ && stratum_ == Stratum::Inside ? mem::Displaced::WrittenLater : displaced_;
  }
  DramTraffic traffic() const {
    return traffic_of(machine_, machine_.memory().dirty_sectors() + warmer_.lost_sectors());
  }
  void close_batch(Cycle now, uint32_t started) {
    const BatchCounts counts = counts_of(machine_, now);
    if (at(counts, BatchCount::Cycles) <= at(mark_, BatchCount::Cycles)) return;
    SampleBatch batch{started, counts};
    for (size_t i = 0; i < counts.size(); ++i) batch.counts[i] -= mark_[i];
    batches_.push_back(batch);
    mark_ = counts;
  }

  const SamplePlan& plan_;
  TimingMachine& machine_;
  const mem::Displaced displaced_;
  const bool is_shared_;
  Stratum stratum_ = Stratum::Inside;  // of the block that runs functionally
  Warmer warmer_;
  size_t next_warm_ = 0, next_start_ = 0, segment_ = 0;
  uint32_t last_started_ = 0, first_wave_ = 0;
  bool is_full_ = false;
  bool is_half_done_ = false;
  BatchCounts mark_{}, half_{};
  DramTraffic traffic_of_half_{};
  std::vector<SampleBatch> batches_;
  std::array<std::vector<BlockWork>, size_t(Stratum::Count)> work_;
};

SampleCounts Sampler::finish(Cycle cycles) {
  const DramTraffic at_end = traffic();
  warm(plan_.num_blocks);
  return {.plan = &plan_,
          .work = std::move(work_),
          .batches = std::move(batches_),
          .total = counts_of(machine_, cycles),
          .writes_are_missing = displaced_ == mem::Displaced::Lost,
          .stacks_leave_l2 = is_shared_,
          .traffic = at_end,
          .half = half_,
          .traffic_of_half = traffic_of_half_};
}

// Returns the blocks of the launch that the machine holds at a time.
uint32_t resident_blocks(const GpuParams& gpu, const exec::World& world) {
  return std::max(1u, residency_of(gpu, world).blocks * gpu.cores);
}

// Returns which share of the L2 the stacks of all threads would fill that the machine holds at a time.
double stacks_in_l2(const GpuParams& gpu, const exec::World& world) {
  const mem::Params& memory = gpu.memory;
  return double(core::CoreCell::local_bytes(gpu.core, world)) * gpu.cores /
         double(memory.l2.slice_size * memory.num_slices());
}

// Returns the blocks in a row of the grid, or 0 when it has one row or none.
uint32_t row_of(const exec::World& world) {
  const auto &size = world.launch_size, &block = world.block_size;
  return block[0] && size[1] > block[1] ? size[0] / block[0] : 0;
}

}  // namespace

SampledRun run_sampled(const exec::World& world, const GpuParams& gpu, const SampleOptions& options,
                       uint32_t threads, const LaunchWatch& watch) {
  // Model: of a launch with rays, what blocks share is most of what they touch.
  const bool is_private = !traces_rays(world);
  const uint32_t num_blocks = exec::num_blocks(world);
  Survey survey = survey_for(options, is_private ? num_blocks : 0);
  SampledRun run;
  const auto begin = std::chrono::steady_clock::now();
  const uint32_t scale = largest_scale(gpu, options.share);
  RenderResult& result = run.result;
  std::vector<BlockWork> surveyed = run_survey(world, gpu, survey, result.faults);
  run.plan =
      plan_sample(options, num_blocks, resident_blocks(cut(gpu, scale), world), scale, survey, row_of(world));
  if (survey.asks == Question::Lines) {
    std::vector<BlockWork> left_out;
    for (const uint32_t index : survey.left_out_by(run.plan)) left_out.push_back(surveyed[index]);
    if (!left_out.empty()) surveyed = std::move(left_out);
  }
  const bool is_shared = !is_private && scale > 1 && stacks_in_l2(gpu, world) > 1;
  const double l2_lines =
      double(gpu.memory.l2.slice_size * gpu.memory.num_slices()) / double(gpu.memory.line);
  const GpuParams part = cut(gpu, scale, footprint_share(survey, run.plan, l2_lines));
  auto machine = std::make_unique<TimingMachine>(part, world, false, HostOptions{.threads = threads});
  Sampler sampler(run.plan, *machine, world, std::move(surveyed),
                  is_private ? mem::Displaced::WrittenLater : mem::Displaced::Lost, is_shared);
  if (is_shared) machine->memory().share_with(scale - 1);
  for (const Address line : survey.fetched_before(double(run.plan.timed.size()) / num_blocks))
    machine->memory().warm(line, uint8_t((1u << gpu.memory.line / mem::kSectorBytes) - 1));
  result.cycles = machine->run(watch, &sampler);
  result.end = machine->end();
  result.progress = machine->progress();
  machine->collect(result);
  result.faults.add(machine->passed());
  auto stats = std::make_unique<RunStats>(std::move(machine));
  if (result.end == LaunchEnd::Whole) {
    const SampleCounts counts = sampler.finish(result.cycles);
    if (counts.batches.size() < 2)
      throw UserError({}, "the sample has too few segments for an interval", "take a larger share");
    run.batches = counts.batches;
    run.estimates = estimate(counts);
    stats->keep(std::make_unique<SampleStats>(&stats->root(), run.estimates));
  }
  result.faults.add(sampler.passed());
  result.stats = std::move(stats);
  for (const ClassCounts& counts : result.by_class) {
    result.warp_instructions += counts.instructions;
    result.lane_instructions += counts.lanes;
  }
  result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return run;
}

SampledRun render_sampled(RenderJob& job, const SampleOptions& options) {
  survey_for(options);  // A share that is out of range is told before the scene is built.
  SceneWorld scene(job, SceneWorld::Drain{job.scene});
  scene.world.on_fault = job.on_fault;
  SampledRun run = run_sampled(scene.world, job.gpu, options, job.threads, job.watch);
  read_frame(scene, job, run.result);
  return run;
}

std::string batches_csv(const SampledRun& run) {
  std::string out = "started," + batch_columns() + "\n";
  for (const SampleBatch& batch : run.batches)
    out += fmt::format("{}{}\n", batch.started, batch_cells(batch.counts));
  return out;
}

}  // namespace glint::pipeline
