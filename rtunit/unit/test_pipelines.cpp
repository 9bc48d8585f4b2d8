// Decides when the tests of the RT unit start and end.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/unit/test_pipelines.h"

#include <algorithm>
#include <bit>

#include "base/num_lanes.h"

namespace glint::rt {

TestPipelines::TestPipelines(const Params& params, const mem::AddressSpace& memory, RayWalk& walk)
    : num_lanes_(size_t{params.slots()} * kLanes), test_(params.node_test.make({memory})), walk_(walk) {
  add(params.box);
  add(params.triangle);
  add(params.transform);
}

Pipe TestPipelines::add(const PipelineParams& params) {
  pipes_.emplace_back(params, num_lanes_);
  return Pipe(pipes_.size() - 1);
}

void TestPipelines::push(const Read& read, uint32_t slot, LaneMask lanes) {
  const uint8_t starts = read.pipe <= kTransformPipe ? test_->starts(read.what) : uint8_t{1};
  Pipeline& pipe = pipes_[read.pipe];
  pipe.waiting.push({slot, lanes, starts, starts});
  pipe.num_waiting += num_lanes(lanes);
  with_waiting_ |= 1u << read.pipe;
  walk_.prefetch_node(read.what);
  walk_.prefetch_ray(slot, std::countr_zero(lanes));
}

void TestPipelines::end_tests(Cycle now) {
  next_end_ = kNever;
  for (Pipeline& pipe : pipes_) {
    while (!pipe.running.empty() && pipe.running.front().ready <= now) {
      const Running done = pipe.running.front();
      pipe.running.pop();
      walk_.end_test(done.slot, done.lane, now);
    }
    if (pipe.running.empty()) continue;
    next_end_ = std::min(next_end_, pipe.running.front().ready);
    walk_.prefetch_ray(pipe.running.front().slot, pipe.running.front().lane);
  }
}

void TestPipelines::start_tests(Cycle now, uint32_t index) {
  Pipeline& pipe = pipes_[index];
  if (!pipe.is_used || now >= pipe.interval_start + pipe.params.interval) {
    pipe.is_used = true;
    pipe.interval_start = now;
    pipe.started = 0;
  }
  for (; pipe.started < pipe.params.units && !pipe.waiting.empty(); ++pipe.started) {
    Waiting& next = pipe.waiting.front();
    if (--next.starts_left) continue;
    next.starts_left = next.starts;
    const auto lane = uint8_t(std::countr_zero(next.lanes));
    walk_.start_test(next.slot, lane, now);
    pipe.running.push({now + pipe.params.latency, next.slot, lane});
    next_end_ = std::min(next_end_, now + pipe.params.latency);
    --pipe.num_waiting;
    next.lanes &= next.lanes - 1;
    if (next.lanes != 0)
      walk_.prefetch_ray(next.slot, std::countr_zero(next.lanes));
    else
      pipe.waiting.pop();
  }
  if (pipe.waiting.empty()) with_waiting_ &= ~(1u << index);
}

}  // namespace glint::rt
