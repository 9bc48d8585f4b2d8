// Tests boxes, triangles and instances in pipelines that have a rate and a latency.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
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
  void finish_tests(Cycle now);
  void start_tests(Cycle now);
  Cycle next_event() const;

  bool is_any_waiting() const { return num_waiting_ != 0; }
  bool is_any_running() const { return num_running_ != 0; }
  size_t num_tests(Pipe pipe) const { return pipes_[pipe].waiting.size() + pipes_[pipe].running.size(); }

 private:
  struct Test {
    uint32_t slot = 0;
    uint8_t lane = 0;
    uint8_t starts_left = 1;  // A leaf of two triangles needs two.
  };
  struct Running {
    Cycle ready = 0;
    uint32_t slot = 0;
    uint8_t lane = 0;
  };
  struct Pipeline {
    Pipeline(const PipelineParams& p, size_t room) : params(p), waiting(room), running(room) {}
    PipelineParams params;
    mem::Ring<Test> waiting;
    mem::Ring<Running> running;
    Cycle interval_start = 0;
    uint32_t started = 0;  // tests started in the interval that began at interval_start
    bool is_used = false;  // interval_start is valid
  };
  uint8_t starts_of(const Read& read) const;

  const size_t num_lanes_;
  const mem::AddressSpace& memory_;
  RayWalk& walk_;
  std::vector<Pipeline> pipes_;                 // by Pipe
  uint32_t num_waiting_ = 0, num_running_ = 0;  // tests in all pipelines
};

}  // namespace glint::rt
