// Runs a launch block by block, the warps of a block in turns.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/functional_machine.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/num_lanes.h"
#include "exec/endless_loops.h"
#include "rtunit/traversal/traversal.h"

namespace glint::pipeline {

using exec::Executor;
using exec::WarpContext;

void answer_rays(Executor& executor, WarpContext& warp, RayCounts& counts) {
  for_each_lane(warp.ray_lanes, [&](int lane) {
    rt::RayState& state = warp.rays[lane];
    const auto nodes = state.nodes_visited, boxes = state.box_tests, triangles = state.triangle_tests;
    if (nodes == 0) ++counts.rays;  // The ray is handed over for the first time, so it is not a resumed one.
    if (state.status == rt::RayStatus::Traversing) rt::run(state, *executor.world().memory);
    counts.nodes += state.nodes_visited - nodes;
    counts.box_tests += state.box_tests - boxes;
    counts.triangle_tests += state.triangle_tests - triangles;
  });
  executor.finish_rays(warp);
}

namespace {

// Choice: a warp runs this many instructions before the next warp of its block does, so that warps that wait
// for each other through memory make progress. Results depend on it only where a warp waits like that.
constexpr uint64_t kQuantum = 10'000;

class Runner {
 public:
  Runner(const exec::World& world, uint64_t instruction_budget, const LaunchWatch& watch,
         core::LaunchCosts* costs)
      : executor(world), world_(world), watch_(watch), budget_(instruction_budget), endless_(*world.image) {
    if (!costs) return;
    costs_ = std::make_unique<core::CostRecorder>(*costs, executor.warps_per_block());
    executor.called.listen([this](const exec::Called& called) {
      costs_->call(called.warp.warp_in_block, called.stage, called.lanes);
    });
  }

  // Returns false when the watch has ended the launch.
  bool run_block(uint32_t index) {
    warps_.resize(executor.warps_per_block());
    executor.start(block_, index);
    for (uint32_t w = 0; w < warps_.size(); ++w) {
      executor.start(warps_[w], block_, w);
      if (costs_) costs_->start_warp(0, w, warps_[w]);
    }
    // The warps take turns. A warp at a barrier waits for one that runs, and the executor ensures that there
    // is one.
    while (block_.live() != 0)
      for (WarpContext& warp : warps_) {
        if (!(block_.live() >> warp.warp_in_block & 1)) continue;
        run_warp(warp);
        if (watch_.stop && watch_.stop()) return false;
        tell(uint64_t{index} * warps_.size());
      }
    return true;
  }

  void tell(uint64_t ended_warps) {
    if (!watch_.progress) return;
    watch_.progress(progress(ended_warps), [this] {
      const auto line = busiest_line();
      return line ? line->place : "";
    });
  }

  LaunchProgress progress(uint64_t ended_warps) const {
    LaunchProgress out{.ended_warps = ended_warps, .num_warps = executor.num_warps()};
    for (const ClassCounts& by_class : counts.by_class) out.instructions += by_class.instructions;
    return out;
  }

  std::optional<exec::BusiestLine> busiest_line() const {
    std::vector<uint32_t> pcs;
    for (const WarpContext& warp : warps_)
      if (block_.live() >> warp.warp_in_block & 1) pcs.push_back(warp.simt.pc);
    return exec::busiest_line(*world_.image, pcs);
  }

  Executor executor;
  FunctionalCounts counts;

 private:
  void run_warp(WarpContext& warp) {
    const uint64_t end = warp.instructions + kQuantum;
    for (bool finished = false; !finished && !warp.waiting_at_barrier && warp.instructions < end;) {
      const exec::Issued issued = executor.execute(warp, 0);
      if (executor.fault()) throw Error(executor.fault()->exit(), executor.passed().with(*executor.fault()));
      ClassCounts& by_class = counts.by_class[size_t(issued.row->klass)];
      ++by_class.instructions;
      by_class.lanes += num_lanes(issued.lanes);
      finished = issued.finished;
      if (costs_) costs_->issue(0, warp.warp_in_block, issued);
      if (warp.waiting_for_rays) answer(warp);
      if (finished && costs_) costs_->end_warp(0, warp.warp_in_block);
      if (warp.instructions > budget_) [[unlikely]]
        throw Error(Exit::Fault,
                    executor.passed().with(exec::no_end_in_sight(world_, warp, issued.pc, budget_)));
    }
    if (endless_.any() && block_.live() >> warp.warp_in_block & 1 && endless_.holds(warp.simt.pc))
      throw Error(Exit::Fault, executor.passed().with(endless_.fault(world_, warp)));
  }

  void answer(WarpContext& warp) {
    const LaneMask lanes = warp.ray_lanes;
    const rt::RayState* rays = warp.rays;
    if (costs_) costs_->start_rays(warp.warp_in_block, lanes, rays);
    answer_rays(executor, warp, counts.rays);
    if (costs_) costs_->end_rays(warp.warp_in_block, lanes, rays);
  }

  const exec::World& world_;
  const LaunchWatch& watch_;
  const uint64_t budget_;
  const exec::EndlessLoops endless_;
  exec::Block block_;
  std::vector<WarpContext> warps_;
  std::unique_ptr<core::CostRecorder> costs_;  // null: costs were not asked for
};

}  // namespace

FunctionalCounts run_functional(const exec::World& world, uint64_t instruction_budget,
                                const LaunchWatch& watch, const Probe<exec::Retired>::Listener& listener,
                                core::LaunchCosts* costs) {
  Runner runner(world, instruction_budget, watch, costs);
  if (listener) runner.executor.retired.listen(listener);
  const uint32_t num_blocks = runner.executor.num_blocks(), warps = runner.executor.warps_per_block();
  for (uint32_t index = 0; index < num_blocks; ++index) {
    if (!runner.run_block(index)) {
      runner.counts.end = LaunchEnd::Stopped;
      runner.counts.progress = runner.progress(uint64_t(index) * warps);
      if (const auto line = runner.busiest_line())
        runner.counts.progress.where = line->to_string(*world.image);
      break;
    }
    runner.tell(uint64_t(index + 1) * warps);
  }
  runner.counts.faults = runner.executor.passed();
  runner.counts.not_finite = runner.executor.not_finite_stores();
  return runner.counts;
}

}  // namespace glint::pipeline
