// The RT unit of a core: a warp buffer whose rays fetch nodes through the L1 and test them in pipelines.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/probe.h"
#include "memsys/address_space.h"
#include "memsys/l1_port.h"
#include "memsys/ring.h"
#include "rtunit/params.h"
#include "rtunit/rt_port.h"
#include "rtunit/traversal/traversal.h"
#include "rtunit/unit/rt_stats.h"

namespace glint::rt {

// A lane's visit of a node, told when its test starts.
struct NodeVisited {
  Cycle cycle = 0;
  uint32_t warp_slot = 0;
  int lane = 0;
  Fetch node;
};

// A warp takes a place in the warp buffer, or gives it free (`has_left`).
struct WarpMoved {
  Cycle cycle = 0;
  uint32_t place = 0, warp_slot = 0;
  bool has_left = false;
  LaneMask lanes = 0;
  const RayState* states = nullptr;
};

class RtUnit final : public RtPort {
 public:
  struct Context {
    const mem::AddressSpace& memory;
    mem::L1Port& l1;
    stats::Group* stats = nullptr;
    Address results = 0;   // physical, line-aligned: result_bytes() of it
    TableLayout tables{};  // line-aligned; where rays that gather candidates have theirs written
    Address stacks = 0;    // physical, line-aligned: stack_bytes_per_warp() for each warp slot of the core
  };
  RtUnit(const Params& params, const Context& context);
  // What Context::results must hold; 0: it is not used.
  static uint64_t result_bytes(const Params& params);
  static uint64_t stack_bytes_per_warp(const Params& params);

  bool can_accept() const override { return num_resident_ < slots_.size(); }
  void submit(Cycle now, uint32_t warp_slot, LaneMask mask, RayState* states) override;
  std::optional<uint32_t> pop_completion(Cycle now) override;
  void tick(Cycle now) override;
  // The L1's answers are new input: the L1's own next_event() tells of them.
  Cycle next_event(Cycle now) const override;

  std::string describe() const override;

  // Gives the cycles up to `end` to their reasons: once, at the end of the run.
  void finish(Cycle end) { account_gap(end); }
  const RtStats& stats() const { return stats_; }
  // RtStats::warp_cycles as it will be at the start of cycle `at`, when nothing happens before.
  uint64_t warp_cycles_until(Cycle at) const {
    return stats_.warp_cycles.value() + (at - next_unaccounted_) * gap_warps_;
  }
  uint32_t num_resident() const { return num_resident_; }
  Probe<NodeVisited>& node_visited() { return node_visited_; }
  Probe<WarpMoved>& warp_moved() { return warp_moved_; }
  // Tells each(warp slot, lanes) of whom the read that is just being sent is for. `token` is that of its
  // request.
  template <class Each>
  void for_each_reader(mem::Token token, Each&& each) const {
    if (token != sending_) {  // a fill of a stack has no fetch yet
      const StackOp& op = stack_ops_.front();
      return each(slots_[op.slot].warp, LaneMask{1} << op.lane);
    }
    for (uint32_t i = token; i != kNone; i = fetches_[i].next)
      each(slots_[fetches_[i].slot].warp, fetches_[i].lanes);
  }

 private:
  static constexpr uint32_t kNone = ~0u;
  // Choice: stores of single hits begin again at the first place after so many; Vulkan-Sim never does.
  static constexpr uint32_t kHitPlaces = 1 << 16, kHitPlaceBytes = 256;

  // What a lane reads: a node, a header or a leaf's descriptor on its own (Shortcuts), a node that it has
  // visited before, or a sector of its stack.
  enum class Part : uint8_t { Node, Header, Descriptor, Replay, Fill };

  // A place in the warp buffer. A lane of `mask` is in exactly one of: `wanting` a node, a fetch, a test,
  // `stopped`.
  struct Slot {
    bool used = false;
    uint32_t warp = 0;
    LaneMask mask = 0, wanting = 0, stopped = 0, unwritten = 0;
    RayState* states = nullptr;
    uint64_t age = 0;
    Cycle arrived = 0;
    std::array<Fetch, kLanes> node;
    std::array<Part, kLanes> part;
    LaneMask headers = 0,
             described = 0;  // lanes whose next read is a header; whose leaf's descriptor has been read
    uint32_t stores = 0;     // of single hits, to be sent
    Cycle last_store = 0;
    bool is_leaving = false;              // all is done; the last store's acknowledgement is on its way
    std::array<StackWork, kLanes> stack;  // still to be done before the lane's next node
    uint32_t spills = 0;                  // sectors of its lanes' stacks to be sent
    uint32_t rows = 0;                    // of the candidate table with entries to write
    std::array<LaneMask, kMaxTableRows> entries;  // of a row in `rows`: the lanes
  };
  // A node on its way for some lanes of one slot. Its index is the token of its requests.
  struct NodeFetch {
    uint32_t slot = 0;
    LaneMask lanes = 0;
    Fetch node;
    Part part = Part::Node;
    uint32_t sent = 0;        // bytes
    uint32_t unanswered = 0;  // requests
    uint32_t next = kNone;    // another slot's lanes that share it
  };
  // A sector of a lane's stack, to be written or read.
  struct StackOp {
    uint32_t slot = 0;
    uint16_t row = 0;
    uint8_t lane = 0;
    bool is_fill = false;
  };
  struct Test {
    uint32_t slot = 0;
    uint8_t lane = 0;
    uint8_t starts_left = 1;  // a leaf of two triangles takes two
  };
  struct Running {
    Cycle ready = 0;
    uint32_t slot = 0;
    uint8_t lane = 0;
    uint8_t stores = 0;  // of hits, to be sent when the test ends
  };
  struct Pipeline {
    Pipeline(const PipelineParams& p, size_t room) : params(p), waiting(room), running(room) {}
    PipelineParams params;
    mem::Ring<Test> waiting;
    mem::Ring<Running> running;
    Cycle interval_start = 0;
    uint32_t started = 0;  // in the interval that began at interval_start
    bool used = false;     // interval_start means something
  };
  enum Pipe : size_t { kBox, kTriangle, kTransform, kHeader, kDescriptor, kNumPipes };

  void account_gap(Cycle now);
  void account(Cycle now, Stall reason);
  void retire(Cycle now);
  void finish_tests(Cycle now);
  void receive_nodes(Cycle now);
  void hand_out(uint32_t index, Cycle now);
  void start_tests(Cycle now);
  Stall send_requests(Cycle now);
  Stall waiting_reason() const;

  void place(uint32_t slot_index, int lane, Cycle now);
  Fetch next_read(Slot& slot, int lane) const;
  static Pipe pipe_for(const NodeFetch& fetch);
  void stop(Slot& slot, uint32_t slot_index, int lane, Cycle now);
  uint32_t visit(const Test& test, Cycle now);
  void count_node(NodeKind kind);
  bool choose_fetch(Cycle now);
  uint32_t new_fetch(uint32_t slot, LaneMask lanes, const Fetch& node, Part part);
  static LaneMask lanes_wanting(const Slot& slot, const Fetch& node);
  void admit(Slot& slot, uint32_t slot_index, int lane, Cycle now);
  void keep_path(RayState& state, uint32_t warp_slot, int lane);
  bool tend_stack(uint32_t slot_index, int lane);
  bool can_send_stack(Cycle now) const;
  bool send_stack(Cycle now);
  bool is_mshr_full() const { return params_.mshr_entries != 0 && num_fetches_ >= params_.mshr_entries; }
  bool has_reads_waiting() const;
  bool send_node(Cycle now);
  bool send_result(Cycle now);
  bool send_entries(Cycle now);
  bool send_next(Cycle now);
  bool send_hit(Cycle now);
  uint32_t collect_entries(uint32_t slot_index, int lane);
  void leave(uint32_t slot_index, Cycle now);
  void acknowledge(Cycle now);
  bool wants_to_send(Cycle now) const;

  const Params params_;
  const mem::AddressSpace& memory_;
  mem::L1Port& l1_;
  const Address results_;
  const TableLayout tables_;
  RtStats stats_;
  Probe<NodeVisited> node_visited_;
  Probe<WarpMoved> warp_moved_;
  std::unique_ptr<RayScheduler> scheduler_;
  std::unique_ptr<Coalescer> coalescer_;
  std::unique_ptr<ChildOrder> child_order_;
  std::unique_ptr<StackModel> stack_model_;
  const StackLayout stacks_;
  const bool tends_stacks_;                                          // the stack model can ask for something
  std::vector<std::unique_ptr<std::array<RayPath, kLanes>>> paths_;  // by the core's warp slot

  std::vector<Slot> slots_;
  std::vector<WarpView> views_;
  std::vector<NodeFetch> fetches_;  // one a lane at most
  std::vector<uint32_t> free_fetches_;
  std::array<Pipeline, kNumPipes> pipes_;
  mem::Ring<uint32_t> finished_;     // slots whose lanes have all stopped and whose results are written
  mem::Ring<uint32_t> writing_;      // slots with results to write
  mem::Ring<uint32_t> gathering_;    // slots with table entries to write
  mem::Ring<uint32_t> completions_;  // warps given back
  mem::Ring<StackOp> stack_ops_;
  uint32_t sending_ = kNone;  // fetch whose requests have not all been taken
  uint32_t num_resident_ = 0, num_rays_ = 0, num_fetches_ = 0;
  uint32_t num_stores_ = 0, num_leaving_ = 0;  // Slot::stores and is_leaving over all slots
  uint32_t next_hit_place_ = 0;
  uint64_t next_age_ = 0;
  bool has_news_ = false;  // something was submitted since the last tick

  // The past, for cycles that are skipped: nothing happened in them, so they were like the end of the last
  // one.
  Cycle next_unaccounted_ = 0;
  Stall gap_reason_ = Stall::Idle;
  uint32_t gap_warps_ = 0, gap_rays_ = 0;
};

}  // namespace glint::rt
