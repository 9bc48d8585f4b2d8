// Runs a block to its end, the warps in turns.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/block_runner.h"

#include <cstddef>

#include "base/num_lanes.h"

namespace glint::pipeline {

using exec::Executor;
using exec::WarpContext;

namespace {

// Choice: a warp runs this many instructions before the next warp of its block does, so that warps that wait
// for each other through memory make progress. Results depend on it only where a warp waits like that.
constexpr uint64_t kQuantum = 10'000;

}  // namespace

void WorkCounts::add(const WorkCounts& other) {
  for (size_t i = 0; i < by_class.size(); ++i) {
    by_class[i].instructions += other.by_class[i].instructions;
    by_class[i].lanes += other.by_class[i].lanes;
    by_class[i].latency += other.by_class[i].latency;
  }
  rays.rays += other.rays.rays;
  rays.nodes += other.rays.nodes;
  rays.box_tests += other.rays.box_tests;
  rays.triangle_tests += other.rays.triangle_tests;
}

uint64_t WorkCounts::instructions() const {
  uint64_t sum = 0;
  for (const ClassCounts& counts : by_class) sum += counts.instructions;
  return sum;
}

namespace {

// Does what rt::run() does, node by node.
void run_told(rt::RayState& state, const mem::AddressSpace& memory, const BlockRunner::NodeListener& nodes) {
  while (state.status == rt::RayStatus::Traversing) {
    const rt::Fetch fetch = rt::next_fetch(state);
    const std::byte* bytes = memory.find(fetch.address, fetch.bytes);
    if (!bytes) return rt::break_off(state);
    nodes(fetch);
    rt::step(state, bytes);
  }
}

}  // namespace

void answer_rays(Executor& executor, WarpContext& warp, RayCounts& counts,
                 const BlockRunner::NodeListener& listener) {
  const mem::AddressSpace& memory = *executor.world().memory;
  for_each_lane(warp.ray_lanes, [&](int lane) {
    rt::RayState& state = warp.rays[lane];
    const auto nodes = state.nodes_visited, boxes = state.box_tests, triangles = state.triangle_tests;
    if (nodes == 0) ++counts.rays;  // The ray is handed over for the first time, so it is not a resumed one.
    if (state.status == rt::RayStatus::Traversing)
      listener ? run_told(state, memory, listener) : rt::run(state, memory);
    counts.nodes += state.nodes_visited - nodes;
    counts.box_tests += state.box_tests - boxes;
    counts.triangle_tests += state.triangle_tests - triangles;
  });
  executor.finish_rays(warp);
}

bool BlockRunner::run(Executor& executor, uint32_t index, WorkCounts& counts,
                      const std::function<bool()>& is_over, core::CostRecorder* costs,
                      const NodeListener& nodes) {
  instructions_ = 0;
  warps_.resize(executor.warps_per_block());
  executor.start(block_, index);
  for (uint32_t w = 0; w < warps_.size(); ++w) {
    executor.start(warps_[w], block_, w);
    if (costs) costs->start_warp(0, w, warps_[w]);
  }
  // The warps take turns. A warp at a barrier waits for one that runs, and the executor ensures that there is
  // one.
  while (block_.live() != 0)
    for (WarpContext& warp : warps_) {
      if (!(block_.live() >> warp.warp_in_block & 1)) continue;
      const uint64_t before = warp.instructions;
      run_warp(executor, warp, counts, costs, nodes);
      instructions_ += warp.instructions - before;
      if (is_over()) return false;
    }
  return true;
}

void BlockRunner::run_warp(Executor& executor, WarpContext& warp, WorkCounts& counts,
                           core::CostRecorder* costs, const NodeListener& nodes) {
  const uint64_t end = warp.instructions + kQuantum;
  warp.waits_for_phase = false;  // Other warps have had their turns since it asked.
  for (bool finished = false;
       !finished && !warp.waiting_at_barrier && !warp.waits_for_phase && warp.instructions < end;) {
    const exec::Issued issued = executor.execute(warp, 0);
    if (executor.fault()) throw Failed{*executor.fault()};
    ClassCounts& by_class = counts.by_class[size_t(issued.row->klass)];
    ++by_class.instructions;
    by_class.lanes += num_lanes(issued.lanes);
    finished = issued.finished;
    if (costs) costs->issue(0, warp.warp_in_block, issued);
    if (warp.waiting_for_rays) {
      const LaneMask lanes = warp.ray_lanes;
      const rt::RayState* rays = warp.rays;
      if (costs) costs->start_rays(warp.warp_in_block, lanes, rays);
      answer_rays(executor, warp, counts.rays, nodes);
      if (costs) costs->end_rays(warp.warp_in_block, lanes, rays);
    }
    if (finished && costs) costs->end_warp(0, warp.warp_in_block);
    if (warp.instructions > budget_) [[unlikely]]
      throw Failed{exec::no_end_in_sight(world_, warp, issued.pc, budget_)};
  }
  if (endless_.any() && block_.live() >> warp.warp_in_block & 1 && endless_.holds(warp.simt.pc))
    throw Failed{endless_.fault(world_, warp)};
}

std::optional<exec::BusiestLine> BlockRunner::busiest_line() const {
  std::vector<uint32_t> pcs;
  for (const WarpContext& warp : warps_)
    if (block_.live() >> warp.warp_in_block & 1) pcs.push_back(warp.simt.pc);
  return exec::busiest_line(*world_.image, pcs);
}

}  // namespace glint::pipeline
