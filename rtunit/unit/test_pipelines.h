// Tests boxes, triangles and instances in pipelines that have a rate and a latency.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "memsys/address_space.h"
#include "memsys/ring.h"
#include "rtunit/params.h"
#include "rtunit/unit/ray_walk.h"

namespace glint::rt {

class TestPipelines {
 public:
  TestPipelines(const Params& params, const mem::AddressSpace& memory, RayWalk& walk);
  // Adds a pipeline for tests of another kind. Returns its number.
  Pipe add(const PipelineParams& params);

  // Puts a read that has arrived into its pipeline, for each of these lanes.
  void push(const Read& read, uint32_t slot, LaneMask lanes);
  void finish_tests(Cycle now) {
    if (now >= next_end_) end_tests(now);
  }
  void start_tests(Cycle now) {
    for (uint32_t rest = with_waiting_; rest; rest &= rest - 1)
      start_tests(now, uint32_t(std::countr_zero(rest)));
  }
  Cycle next_event() const {
    Cycle next = next_end_;
    for (uint32_t rest = with_waiting_; rest; rest &= rest - 1) {
      const Pipeline& pipe = pipes_[size_t(std::countr_zero(rest))];
      next = std::min(next, pipe.interval_start + pipe.params.interval);
    }
    return next;
  }

  bool is_any_waiting() const { return with_waiting_ != 0; }
  bool is_any_running() const { return next_end_ != kNever; }
  size_t num_tests(Pipe pipe) const { return pipes_[pipe].num_waiting + pipes_[pipe].running.size(); }

 private:
  // Holds the lanes of a warp that wait for their tests of a node, of which the lowest is next.
  struct Waiting {
    uint32_t slot = 0;
    LaneMask lanes = 0;
    uint8_t starts = 1;       // NodeTest::starts()
    uint8_t starts_left = 1;  // of the next lane
  };
  struct Running {
    Cycle ready = 0;
    uint32_t slot = 0;
    uint8_t lane = 0;
  };
  struct Pipeline {
    Pipeline(const PipelineParams& p, size_t room) : params(p), waiting(room), running(room) {}
    PipelineParams params;
    mem::Ring<Waiting> waiting;
    mem::Ring<Running> running;
    uint32_t num_waiting = 0;  // lanes in `waiting`
    Cycle interval_start = 0;
    uint32_t started = 0;  // tests started in the interval that began at interval_start
    bool is_used = false;  // interval_start is valid
  };
  void end_tests(Cycle now);
  void start_tests(Cycle now, uint32_t pipe);

  const size_t num_lanes_;
  const std::unique_ptr<NodeTest> test_;
  RayWalk& walk_;
  std::vector<Pipeline> pipes_;  // by Pipe
  uint32_t with_waiting_ = 0;    // bit i: tests wait in pipes_[i]
  Cycle next_end_ = kNever;      // when the first of all running tests ends
};

}  // namespace glint::rt
