// Running a launch warp by warp.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/functional_machine.h"

#include "base/num_lanes.h"
#include "rtunit/traversal.h"

namespace glint::pipeline {

using core::Executor;
using core::WarpContext;

void answer_rays(Executor& executor, WarpContext& warp, RayCounts& counts) {
  for_each_lane(warp.ray_lanes, [&](int lane) {
    rt::RayState& state = warp.rays[lane];
    const auto nodes = state.nodes_visited, boxes = state.box_tests, triangles = state.triangle_tests;
    if (nodes == 0) ++counts.rays;  // first hand-over: a ray, not a resumed one
    if (state.status == rt::RayStatus::Traversing) rt::run(state, *executor.world().memory);
    counts.nodes += state.nodes_visited - nodes;
    counts.box_tests += state.box_tests - boxes;
    counts.triangle_tests += state.triangle_tests - triangles;
  });
  executor.finish_rays(warp);
}

FunctionalCounts run_functional(const core::World& world, uint64_t instruction_budget,
                                const std::function<void(uint64_t, uint64_t)>& progress,
                                const Probe<core::Retired>::Listener& listener) {
  FunctionalCounts counts;
  Executor executor(world);
  if (listener) executor.retired.listen(listener);
  WarpContext warp;
  const uint32_t num_warps = executor.num_warps();
  for (uint32_t index = 0; index < num_warps; ++index) {
    executor.start(warp, index);
    bool finished = false;
    while (!finished) {
      const core::Issued issued = executor.execute(warp, 0);
      if (executor.fault()) throw Error(Exit::Fault, executor.fault()->to_string());
      ClassCounts& by_class = counts.by_class[size_t(issued.row->klass)];
      ++by_class.instructions;
      by_class.lanes += num_lanes(issued.lanes);
      finished = issued.finished;
      if (warp.waiting_for_rays) answer_rays(executor, warp, counts.rays);
      if (warp.instructions > instruction_budget) [[unlikely]]
        throw Error(Exit::Fault, core::no_end_in_sight(world, warp, issued.pc, instruction_budget).to_string());
    }
    if (progress) progress(index + 1, num_warps);
  }
  return counts;
}

}  // namespace glint::pipeline
