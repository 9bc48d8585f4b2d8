// Models the RT unit of a core in the interval model: warps that share a request port and test pipes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <queue>
#include <utility>
#include <vector>

#include "exec/warp_context.h"
#include "memsys/address_space.h"
#include "pipeline/interval/memory_model.h"
#include "rtunit/params.h"
#include "rtunit/traversal/traversal.h"

namespace glint::pipeline {

struct RayModelCounts {
  uint64_t rays = 0, nodes = 0, requests = 0, traces = 0;
  uint64_t trace_cycles = 0;  // cycles from a warp's entry to its last ray's end, summed
  void add(const RayModelCounts& other) {
    rays += other.rays, nodes += other.nodes, requests += other.requests, traces += other.traces;
    trace_cycles += other.trace_cycles;
  }
};

// Advances rays node by node. Rays of a warp that want the same node at the same time share its fetch, and
// the oldest warp goes first. Model: stacks are whole, and any number of answers comes in a cycle.
class RayModel {
 public:
  RayModel(const rt::Params& params, const mem::AddressSpace& memory, MemoryModel& caches, uint32_t core);

  // Takes the rays of a warp. `warp` stays where it is until it is done.
  void submit(Cycle at, uint32_t slot, exec::WarpContext& warp);
  // Returns when advance() has something to do, or kNever without rays.
  Cycle next() const;
  // Does what is due at next().
  void advance();
  // Returns slot and cycle of the warps whose rays have all stopped since the last call. The rays are still
  // to be answered.
  std::vector<std::pair<uint32_t, Cycle>> take_done() { return std::exchange(done_, {}); }

  const RayModelCounts& counts() const { return counts_; }
  // Return cycles of work of the port and of the busiest test pipe. No run is shorter than these.
  double port_work() const { return port_work_; }
  double test_work() const { return std::max({box_.work, triangle_.work, transform_.work}); }

 private:
  struct Trace {
    bool used = false;
    uint32_t slot = 0;
    exec::WarpContext* warp = nullptr;
    LaneMask wanting = 0, travelling = 0;
    uint64_t age = 0;
    Cycle begun = 0;
    std::array<Address, kLanes> node{};
  };
  struct Pipe {
    rt::PipelineParams params;
    double free = 0, work = 0;
  };
  struct Event {
    Cycle at = 0;
    uint64_t order = 0;
    uint32_t trace = 0;
    LaneMask lanes = 0;
    bool arrived = false;  // true: the node is there; false: the test is done
    bool operator>(const Event& other) const { return at != other.at ? at > other.at : order > other.order; }
  };

  void begin(Cycle at, uint32_t slot, exec::WarpContext& warp);
  void send(Cycle now);
  void test(const Event& event);
  void go_on(uint32_t index, LaneMask lanes, Cycle now);
  Pipe& pipe_of(rt::NodeKind kind);
  void push(Cycle at, uint32_t trace, LaneMask lanes, bool arrived) {
    events_.push({at, order_++, trace, lanes, arrived});
  }

  const rt::Params& params_;
  const mem::AddressSpace& memory_;
  MemoryModel& caches_;
  const uint32_t core_;
  std::vector<Trace> traces_;
  std::deque<std::pair<uint32_t, exec::WarpContext*>> waiting_;
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
  std::vector<std::pair<uint32_t, Cycle>> done_;
  Pipe box_, triangle_, transform_;
  Cycle now_ = 0;
  double port_free_ = 0, port_work_ = 0;
  uint32_t num_wanting_ = 0;  // number of traces with a lane that wants a node
  uint64_t order_ = 0, age_ = 0;
  RayModelCounts counts_;
};

}  // namespace glint::pipeline
