// Models the RT unit of a core: the rays of its warps fetch nodes through the L1 and test them in pipelines.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/probe.h"
#include "memsys/address_space.h"
#include "memsys/l1_port.h"
#include "rtunit/params.h"
#include "rtunit/rt_port.h"
#include "rtunit/unit/cycle_account.h"
#include "rtunit/unit/fetch_queue.h"
#include "rtunit/unit/prefetch_sender.h"
#include "rtunit/unit/ray_walk.h"
#include "rtunit/unit/request_source.h"
#include "rtunit/unit/rt_stats.h"
#include "rtunit/unit/test_pipelines.h"
#include "rtunit/unit/warp_buffer.h"
#include "rtunit/unit/warp_former.h"
#include "rtunit/unit/work_sharing.h"

namespace glint::rt {

class StackMover;

// Wires the stages of the unit. The data goes through them in this order:
//   WarpBuffer     holds the warps; a lane wants a node
//   FetchQueue     chooses a node for the lanes that want it, and reads it through the L1
//   TestPipelines  test the node that has arrived
//   RayWalk        makes the traversal's step; then the lane wants its next node, or stops
//   writers        send what must be in memory: ResultWriter, TableWriter, StackMover
// Parts that only some configurations have are hooks of the walk, sources of requests and exits of the warp
// buffer (walk_hook.h, request_source.h, warp_buffer.h). The constructor makes those that are needed, so that
// no stage asks for them each cycle.
class RtUnit final : public RtPort {
 public:
  struct Context {
    const mem::AddressSpace& memory;
    mem::L1Port& l1;
    stats::Group* stats = nullptr;
    Address results = 0;   // physical and line-aligned; result_bytes() long
    TableLayout tables{};  // line-aligned; candidates of rays with tables are written here
    Address stacks = 0;    // physical and line-aligned; stack_bytes_per_warp() for each warp slot of the core
    Address ray_states = 0;  // physical and line-aligned; pool_bytes() long
  };
  RtUnit(const Params& params, const Context& context);
  // Returns the bytes that Context::results must hold. 0: it is not used.
  static uint64_t result_bytes(const Params& params);
  static uint64_t stack_bytes_per_warp(const Params& params);
  // Returns the bytes of the SM's shared memory that the stacks of a warp's rays take.
  static uint32_t shared_bytes_per_warp(const Params& params);
  // Returns the bytes that Context::ray_states must hold. 0: they are not used.
  static uint64_t pool_bytes(const Params& params);
  // Returns the number of warps that the unit accepts at once.
  static uint32_t places(const Params& params);
  // Returns why the chosen policies do not go together, or nothing when they do.
  static std::string why_not_together(const Params& params);
  // Returns a chosen policy that asks for treelets, as a clause like "rt.order = ...", or nothing.
  static std::string who_needs_treelets(const Params& params);

  void submit(Cycle now, uint32_t warp_slot, LaneMask mask, RayState* states) override;
  std::optional<uint32_t> pop_completion(Cycle now) override;
  void tick(Cycle now) override {
    if (is_due(now) | l1_.has_answer(now, mem::Client::RtUnit)) has_parts_ ? run<true>(now) : run<false>(now);
  }
  // The L1's answers are new input, and the L1's next_event() tells of them.
  Cycle next_event(Cycle now) const override { return due() == kNever ? kNever : std::max(due(), now + 1); }

  std::string describe() const override;

  // Accounts the cycles up to `end`. It is called once, at the end of the run.
  void finish(Cycle end) { account_.skip_to(end); }
  const RtStats& stats() const {
    account_.settle();
    return stats_;
  }
  // Returns RtStats::warp_cycles as it will be at the start of cycle `at`, when nothing happens before.
  uint64_t warp_cycles_until(Cycle at) const { return account_.warp_cycles_until(at); }
  uint32_t num_resident() const { return former_ ? former_->num_accepted() : buffer_.num_resident(); }
  Probe<NodeVisited>& node_visited() { return walk_.node_visited(); }
  Probe<WarpMoved>& warp_moved() { return former_ ? former_->warp_moved() : buffer_.warp_moved(); }
  // Calls each(warp slot, lanes) for all whose rays the read that is just being sent serves. `token` is the
  // token of its request.
  template <class Each>
  void for_each_reader(mem::Token token, Each&& each) const {
    fetches_.for_each_reader(token, [&](uint32_t slot, LaneMask lanes) {
      const BufferSlot& at = buffer_[slot];
      if (at.threads)
        for_each_lane(
            lanes, [&](int lane) { each(at.threads[lane].warp_slot, LaneMask{1} << at.threads[lane].lane); });
      else
        each(at.warp_slot, at.owners_of(lanes));
    });
  }

 private:
  void add_optional_parts(const Params& params, const Context& context);
  void add_stack_mover(std::unique_ptr<StackModel> model, const Context& context);
  template <class Part, class... Args>
  Part& add(Args&&... args);

  // With `kHasParts` the unit has parts that not every configuration has.
  template <bool kHasParts>
  void run(Cycle now);
  void receive(Cycle now);
  template <bool kHasParts>
  std::optional<Stall> send_requests(Cycle now);
  RequestSource* next_source(Cycle now);
  bool has_reads_waiting() const;
  void tell_core();
  Stall idle_reason() const;
  template <bool kHasParts>
  Cycle find_due(Cycle now) const;

  const uint32_t requests_per_cycle_;
  const mem::L1Port& l1_;
  RtStats stats_;
  WarpBuffer buffer_;
  RayWalk walk_;
  TestPipelines pipelines_;
  FetchQueue fetches_;
  CycleAccount account_;
  std::vector<std::shared_ptr<void>> parts_;  // owns the parts that not every configuration has
  std::vector<RequestSource*> sources_;       // the sources among these parts, by priority
  PrefetchSender* prefetches_ = nullptr;      // sends when no source does
  WarpFormer* former_ = nullptr;              // forms the warps, when there is a pool
  StackMover* shared_stacks_ = nullptr;       // keeps parts of stacks in shared memory
  WorkSharing* sharing_ = nullptr;            // lets lanes help each other
  std::vector<std::function<void(Cycle)>> before_tests_, after_requests_;  // further steps of a cycle
  bool has_parts_ = false;  // There is a part in one of the members above.
};

}  // namespace glint::rt
