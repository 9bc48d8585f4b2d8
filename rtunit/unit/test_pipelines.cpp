// Decides when the tests of the RT unit start and end.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/unit/test_pipelines.h"

#include <algorithm>
#include <cstring>

#include "base/num_lanes.h"

namespace glint::rt {

TestPipelines::TestPipelines(const Params& params, const mem::AddressSpace& memory, RayWalk& walk)
    : num_lanes_(size_t{params.warps} * kLanes), memory_(memory), walk_(walk) {
  add(params.box);
  add(params.triangle);
  add(params.transform);
}

Pipe TestPipelines::add(const PipelineParams& params) {
  pipes_.emplace_back(params, num_lanes_);
  return Pipe(pipes_.size() - 1);
}

void TestPipelines::push(const Read& read, uint32_t slot, LaneMask lanes) {
  const uint8_t starts = starts_of(read);
  num_waiting_ += num_lanes(lanes);
  for_each_lane(lanes, [&](int lane) { pipes_[read.pipe].waiting.push({slot, uint8_t(lane), starts}); });
}

uint8_t TestPipelines::starts_of(const Read& read) const {
  if (read.pipe != kTrianglePipe || read.what.kind != NodeKind::Triangle) return 1;
  TriangleLeaf leaf;
  std::memcpy(&leaf, memory_.find(read.what.address, sizeof leaf), sizeof leaf);
  return leaf.count > 1 ? 2 : 1;
}

void TestPipelines::finish_tests(Cycle now) {
  for (Pipeline& pipe : pipes_)
    while (!pipe.running.empty() && pipe.running.front().ready <= now) {
      const Running done = pipe.running.front();
      pipe.running.pop();
      --num_running_;
      walk_.end_test(done.slot, done.lane, now);
    }
}

void TestPipelines::start_tests(Cycle now) {
  for (Pipeline& pipe : pipes_) {
    if (pipe.waiting.empty()) continue;
    if (!pipe.is_used || now >= pipe.interval_start + pipe.params.interval) {
      pipe.is_used = true;
      pipe.interval_start = now;
      pipe.started = 0;
    }
    for (; pipe.started < pipe.params.units && !pipe.waiting.empty(); ++pipe.started) {
      Test& test = pipe.waiting.front();
      if (--test.starts_left) continue;
      walk_.start_test(test.slot, test.lane, now);
      pipe.running.push({now + pipe.params.latency, test.slot, test.lane});
      pipe.waiting.pop();
      --num_waiting_;
      ++num_running_;
    }
  }
}

Cycle TestPipelines::next_event() const {
  Cycle next = kNever;
  for (const Pipeline& pipe : pipes_) {
    if (!pipe.running.empty()) next = std::min(next, pipe.running.front().ready);
    if (!pipe.waiting.empty()) next = std::min(next, pipe.interval_start + pipe.params.interval);
  }
  return next;
}

}  // namespace glint::rt
