// Charges the lanes of a warp for what it does.
// SPDX-License-Identifier: Apache-2.0
#include "core/cost_recorder.h"

#include <fmt/format.h>
#include <numeric>
#include <utility>

#include "base/diagnostics.h"
#include "base/num_lanes.h"

namespace glint::core {
namespace {

size_t num_threads(const exec::World& world) {
  const uint64_t threads = uint64_t{world.launch_size[0]} * world.launch_size[1] * world.launch_size[2];
  if (threads > LaunchCosts::kMaxThreads)
    throw UserError({}, fmt::format("a launch of {} threads is too large for maps of cost", threads),
                    fmt::format("leave out --heat, or launch at most {}", LaunchCosts::kMaxThreads));
  return size_t(threads);
}

}  // namespace

LaunchCosts::LaunchCosts(const exec::World& world) : world_(world), threads_(num_threads(world)) {
}

void CostRecorder::start_warp(Cycle, uint32_t slot, const exec::WarpContext& warp) {
  slots_[slot] = {};
  slots_[slot].warp_index.fill(warp.warp_index);
  std::iota(slots_[slot].first_lane.begin(), slots_[slot].first_lane.end(), uint8_t{0});
}

// Charges the cycles since the last instruction to the threads that executed it.
void CostRecorder::charge_until(Cycle now, Slot& warp) {
  for_each_lane(warp.last,
                [&](int lane) { warp.lane[size_t(lane)].active_cycles += uint32_t(now - warp.last_issue); });
  warp.last_issue = now;
}

void CostRecorder::issue(Cycle now, uint32_t slot, const exec::Issued& issued) {
  Slot& warp = slots_[slot];
  charge_until(now, warp);
  warp.last = issued.lanes;
  for_each_lane(issued.lanes & ~warp.started, [&](int lane) { warp.first[size_t(lane)] = now; });
  warp.started |= issued.lanes;
  for_each_lane(issued.lanes, [&](int lane) {
    ++warp.lane[size_t(lane)].instructions;
    warp.end[size_t(lane)] = now;
  });
  // Choice: the slots of an instruction whose guard is false in all lanes go to the lanes that came to it.
  const LaneMask payers = issued.lanes ? issued.lanes : issued.active;
  const double share = double(kLanes) / double(num_lanes(payers));
  for_each_lane(payers, [&](int lane) { warp.lane[size_t(lane)].slots += share; });
  warp.present |= payers;
}

void CostRecorder::call(uint32_t slot, isa::Stage stage, LaneMask lanes) {
  if (stage != isa::Stage::AnyHit && stage != isa::Stage::Intersection) return;
  const auto counter =
      stage == isa::Stage::AnyHit ? &ThreadCost::any_hit_calls : &ThreadCost::intersection_calls;
  for_each_lane(lanes, [&](int lane) { ++(slots_[slot].lane[size_t(lane)].*counter); });
}

void CostRecorder::start_rays(uint32_t slot, LaneMask lanes, const rt::RayState* states) {
  Slot& warp = slots_[slot];
  for_each_lane(lanes, [&](int lane) {
    const rt::RayState& state = states[lane];
    if (state.nodes_visited == 0)
      ++warp.lane[size_t(lane)].rays;  // a ray that goes on has already visited some
    warp.nodes[size_t(lane)] = state.nodes_visited;
    warp.triangle_tests[size_t(lane)] = state.triangle_tests;
  });
}

void CostRecorder::end_rays(uint32_t slot, LaneMask lanes, const rt::RayState* states) {
  Slot& warp = slots_[slot];
  for_each_lane(lanes, [&](int lane) {
    ThreadCost& cost = warp.lane[size_t(lane)];
    cost.nodes += states[lane].nodes_visited - warp.nodes[size_t(lane)];
    cost.triangle_tests += states[lane].triangle_tests - warp.triangle_tests[size_t(lane)];
  });
}

void CostRecorder::miss(uint32_t slot, LaneMask lanes, int of) {
  const double share = 1.0 / double(of);
  for_each_lane(lanes, [&](int lane) { slots_[slot].lane[size_t(lane)].l1_misses += share; });
}

void CostRecorder::swap_threads(Cycle now, uint32_t slot_a, int lane_a, uint32_t slot_b, int lane_b) {
  Slot &a = slots_[slot_a], &b = slots_[slot_b];
  const auto i = size_t(lane_a), j = size_t(lane_b);
  charge_until(now, a);
  charge_until(now, b);
  std::swap(a.warp_index[i], b.warp_index[j]);
  std::swap(a.first_lane[i], b.first_lane[j]);
  std::swap(a.first[i], b.first[j]);
  std::swap(a.end[i], b.end[j]);
  std::swap(a.nodes[i], b.nodes[j]);
  std::swap(a.triangle_tests[i], b.triangle_tests[j]);
  std::swap(a.lane[i], b.lane[j]);
  for (const auto mask : {&Slot::present, &Slot::started, &Slot::last})
    swap_bits(a.*mask, lane_a, b.*mask, lane_b);
}

void CostRecorder::end_warp(Cycle, uint32_t slot) {
  Slot& warp = slots_[slot];
  for_each_lane(warp.present, [&](int lane) {
    ThreadCost& cost = warp.lane[size_t(lane)];
    cost.cycles = uint32_t(warp.end[size_t(lane)] - warp.first[size_t(lane)]);
    costs_.at(launch_id(costs_.world(), warp.warp_index[size_t(lane)], warp.first_lane[size_t(lane)])) = cost;
  });
}

}  // namespace glint::core
