// Handles the rays of the interval model: fetches, tests, and the end of a warp's trace.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/interval/ray_model.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/num_lanes.h"

namespace glint::pipeline {

// This is the time from a lane's wish to its request, and from a test's end to the next wish, which the
// unit's registers take. Source: the timing machine's RT unit (rtunit/unit/rt_unit.cpp), which does each in a
// cycle of its own.
constexpr Cycle kStep = 1;

RayModel::RayModel(const rt::Params& params, const mem::AddressSpace& memory, MemoryModel& caches,
                   uint32_t core)
    : params_(params),
      memory_(memory),
      caches_(caches),
      core_(core),
      traces_(params.warps),
      box_{params.box},
      triangle_{params.triangle},
      transform_{params.transform} {
}

void RayModel::submit(Cycle at, uint32_t slot, exec::WarpContext& warp) {
  now_ = std::max(now_, at);
  if (std::ranges::any_of(traces_, [](const Trace& trace) { return !trace.used; }))
    return begin(at, slot, warp);
  waiting_.emplace_back(slot, &warp);
}

void RayModel::begin(Cycle at, uint32_t slot, exec::WarpContext& warp) {
  const auto free = std::ranges::find_if(traces_, [](const Trace& trace) { return !trace.used; });
  *free = {.used = true, .slot = slot, .warp = &warp, .age = age_++, .begun = at};
  ++counts_.traces;
  LaneMask travelling = 0;
  for_each_lane(warp.ray_lanes, [&](int lane) {
    const rt::RayState& state = warp.rays[lane];
    counts_.rays += state.nodes_visited == 0;
    travelling |= LaneMask{state.status == rt::RayStatus::Traversing} << lane;
  });
  free->travelling = travelling;
  go_on(uint32_t(free - traces_.begin()), travelling, at);
}

// Continues lanes whose test has ended, or that have had none yet. Those that travel on want their next node.
void RayModel::go_on(uint32_t index, LaneMask lanes, Cycle now) {
  Trace& trace = traces_[index];
  const bool wanted = trace.wanting != 0;
  for_each_lane(lanes, [&](int lane) {
    rt::RayState& state = trace.warp->rays[lane];
    if (state.status == rt::RayStatus::Traversing) {
      trace.node[size_t(lane)] = rt::next_fetch(state).address;
      trace.wanting |= LaneMask{1} << lane;
    } else {
      trace.travelling &= ~(LaneMask{1} << lane);
    }
  });
  num_wanting_ += !wanted && trace.wanting;
  if (trace.travelling) return;
  trace.used = false;
  counts_.trace_cycles += now - trace.begun;
  done_.emplace_back(trace.slot, now);
  if (waiting_.empty()) return;
  const auto [slot, warp] = waiting_.front();
  waiting_.pop_front();
  begin(now, slot, *warp);
}

Cycle RayModel::next() const {
  const Cycle event = events_.empty() ? kNever : events_.top().at;
  return num_wanting_ ? std::min(event, std::max(now_, Cycle(std::ceil(port_free_)))) : event;
}

void RayModel::advance() {
  const Cycle now = now_ = next();
  while (!events_.empty() && events_.top().at <= now) {
    const Event event = events_.top();
    events_.pop();
    if (event.arrived)
      test(event);
    else
      go_on(event.trace, event.lanes, now);
  }
  if (num_wanting_ && port_free_ <= double(now)) send(now);
}

// Takes the oldest warp that wants a node, and sends one node for all of its lanes that want it. While the L1
// takes shaders' accesses, more lanes come to want the node.
void RayModel::send(Cycle now) {
  if (const Cycle free = caches_.port_free(core_, now); free > now) {
    port_free_ = double(free);
    return;
  }
  uint32_t index = 0;
  uint64_t oldest = ~uint64_t{0};
  for (uint32_t i = 0; i < traces_.size(); ++i)
    if (traces_[i].used && traces_[i].wanting && traces_[i].age < oldest) oldest = traces_[i].age, index = i;
  Trace& trace = traces_[index];
  const int first = std::countr_zero(trace.wanting);
  LaneMask same = 0;
  for_each_lane(trace.wanting, [&](int lane) {
    same |= LaneMask{trace.node[size_t(lane)] == trace.node[size_t(first)]} << lane;
  });
  trace.wanting &= ~same;
  num_wanting_ -= trace.wanting == 0;
  const rt::Fetch fetch = rt::next_fetch(trace.warp->rays[first]);
  if (!memory_.find(fetch.address, fetch.bytes)) {  // A wrong address led to bytes outside of any structure.
    for_each_lane(same, [&](int lane) { rt::break_off(trace.warp->rays[lane]); });
    return push(now, index, same, false);
  }
  Cycle ready = now;
  for (uint32_t part = 0; part < fetch.bytes; part += params_.request_bytes) {
    const Address at = memory_.physical(fetch.address + part);
    const uint32_t bytes = std::min(params_.request_bytes, fetch.bytes - part);
    ready = std::max(ready, caches_.read_bytes(core_, at, bytes, now, Asker::RtUnit));
    port_free_ = std::max(port_free_, double(now)) + 1.0 / params_.requests_per_cycle;
    port_work_ += 1.0 / params_.requests_per_cycle;
    ++counts_.requests;
  }
  push(ready + kStep, index, same, true);
}

RayModel::Pipe& RayModel::pipe_of(rt::NodeKind kind) {
  if (kind == rt::NodeKind::Instance) return transform_;
  return kind == rt::NodeKind::Triangle || kind == rt::NodeKind::TriangleSecond ? triangle_ : box_;
}

// Applies the effect of the test here, and tells its end after the pipe's latency.
void RayModel::test(const Event& event) {
  Trace& trace = traces_[event.trace];
  for_each_lane(event.lanes, [&](int lane) {
    rt::RayState& state = trace.warp->rays[lane];
    const rt::Fetch fetch = rt::next_fetch(state);
    const uint32_t before = state.triangle_tests;
    rt::step(state, memory_.find(fetch.address, fetch.bytes));
    ++counts_.nodes;
    Pipe& pipe = pipe_of(fetch.kind);
    const double starts = std::max<uint32_t>(1, state.triangle_tests - before),
                 busy = starts * pipe.params.interval / pipe.params.units;
    const double begin = std::max(pipe.free, double(event.at));
    pipe.free = begin + busy;
    pipe.work += busy;
    push(Cycle(begin + (starts - 1) * pipe.params.interval) + pipe.params.latency + kStep, event.trace,
         LaneMask{1} << lane, false);
  });
}

}  // namespace glint::pipeline
