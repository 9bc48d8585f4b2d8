// Runs launches on machines that hand each other their caches.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/device.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include "pipeline/functional_machine.h"
#include "pipeline/run_costs.h"
#include "pipeline/run_stats.h"
#include "pipeline/run_trace.h"
#include "pipeline/timing_machine.h"

namespace glint::pipeline {
namespace {

void keep_not_finite(RenderResult& result, exec::NotFiniteStores stores, const exec::Image& image) {
  result.not_finite = std::move(stores);
  for (const auto& [texel, store] : result.not_finite.by_texel())
    result.store_lines.try_emplace(store.pc, image.line_of(store.pc));
}

void add_instructions(RenderResult& result) {
  for (const ClassCounts& counts : result.by_class) {
    result.warp_instructions += counts.instructions;
    result.lane_instructions += counts.lanes;
  }
}

}  // namespace

void Device::run_timed(const exec::World& world, const LaunchMode& mode, const LaunchWatch& watch,
                       core::LaunchCosts* costs, RenderResult& result) {
  mem::MemoryContents before = std::exchange(contents_, {});
  auto machine =
      std::make_unique<TimingMachine>(gpu_, world, mode.no_skip, HostOptions{.threads = mode.threads});
  if (mode.caches == Caches::Warm && !before.empty()) machine->memory().put_contents(std::move(before));
  observe(*machine, mode.observe);
  const auto cost_recorders =
      costs ? record_costs(*machine, *costs) : std::vector<std::unique_ptr<core::CostRecorder>>{};
  const auto trace_recorders =
      mode.observe.trace.wanted ? record_trace(*machine, *world.image, mode.observe.trace) : TraceRecorders{};
  result.cycles = machine->run(watch);
  result.end = machine->end();
  result.progress = machine->progress();
  machine->collect(result);
  result.faults = machine->passed();
  keep_not_finite(result, machine->not_finite_stores(), *world.image);
  if (mode.observe.profile) result.profile = profile_of(*machine, *world.image);
  if (mode.observe.sample) result.series = series_of(*machine, mode.observe.sample);
  if (mode.observe.trace.wanted)
    result.trace =
        trace_of(*machine, *world.image, mode.observe.trace, trace_recorders, mode.observe.interval());
  if (result.end == LaunchEnd::Whole) contents_ = machine->memory().take_contents();
  result.stats = std::make_unique<RunStats>(std::move(machine));
}

RenderResult functional_result(const FunctionalCounts& counts, const exec::World& world) {
  RenderResult result;
  result.end = counts.end;
  result.progress = counts.progress;
  std::copy(counts.by_class.begin(), counts.by_class.end(), result.by_class);
  result.rays = counts.rays;
  result.faults = counts.faults;
  keep_not_finite(result, counts.not_finite, *world.image);
  result.stats = std::make_unique<RunStats>(counts);
  add_instructions(result);
  return result;
}

RenderResult Device::run(const exec::World& world, const LaunchMode& mode, const LaunchWatch& watch) {
  RenderResult result;
  const auto costs = mode.observe.heat ? std::make_unique<core::LaunchCosts>(world) : nullptr;
  const auto begin = std::chrono::steady_clock::now();
  if (mode.timing) {
    run_timed(world, mode, watch, costs.get(), result);
    add_instructions(result);
  } else {
    result = functional_result(
        run_functional(world, gpu_.core.instruction_budget, watch, {}, costs.get(), mode.threads), world);
  }
  if (costs) result.costs = cost_maps(*costs, mode.timing);
  result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace glint::pipeline
