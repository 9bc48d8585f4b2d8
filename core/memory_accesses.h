// Handles the memory accesses of a core's warps from issue to completion, and the fences that wait for them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "core/access_lines.h"
#include "core/async_copies.h"
#include "core/core_parts.h"
#include "core/lsu.h"
#include "core/subwarp_unit.h"

namespace glint::core {

// Holds the registers of an access until it has been read or answered, and gives the access to the load-store
// unit.
class MemoryAccesses {
 public:
  struct Context {
    Lsu& lsu;
    LocalLayout local;       // layout of the core's lanes' stacks
    rt::TableLayout tables;  // layout of the candidates of the core's rays
    // This is the length of the turns after which other cores see what this one wrote. 0 means that there are
    // no others.
    Cycle turn = 0;
    MbarrierUnit* barriers = nullptr;  // null: the program has no barriers in shared memory
    SubwarpUnit* subwarps = nullptr;   // null: a path runs until it ends
  };
  MemoryAccesses(const CoreParts& core, const Context& context);

  // Notes that a warp begins in the slot.
  void start_warp(uint32_t slot) {
    pending_[slot] = {};
    if (copies_) copies_->start_warp(slot);
    if (subwarps_) subwarps_->start_warp(slot);
  }
  // Hands the access of an executed instruction to the load-store unit. Returns false when no lane makes one.
  bool start(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now);
  // Starts a fence. The warp goes on a latency after its earlier accesses are done. A fence among cores lasts
  // until the other cores see what came before it, however short its latency.
  void start_fence(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now);
  // Ends a group of asynchronous copies, or lets the warp wait for groups.
  void order_copies(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now) {
    copies_->order(slot, row, issued, now);
  }
  // Takes the accesses that the load-store unit has read or completed in this cycle, after the unit's tick.
  void take_answers(Cycle now) {
    if (lsu_.has_news()) take_news(now);
    if (copies_) [[unlikely]]
      take_late_copies(now);
  }
  // Returns the earliest cycle in which take_answers() has work that is not the load-store unit's, or kNever.
  Cycle next_event() const { return copies_ ? copies_->next_event() : kNever; }

  // Returns the accesses of the slot's warp between issue and completion.
  uint32_t in_flight(uint32_t slot) const { return pending_[slot].accesses + pending_[slot].copies; }
  // Frees the slot of a warp that has ended, now or when the last of its accesses has completed.
  void retire(uint32_t slot, Cycle now) {
    if (in_flight(slot) == 0)
      core_.warps.free(slot, now);
    else
      core_.warps.drain(slot);
  }
  // Returns the lanes of access `access`, the token of its requests, that touch a line. `slot` becomes the
  // slot of their warp.
  LaneMask readers_of(mem::Token access, Address line, uint32_t& slot) const;

 private:
  struct Pending {
    uint32_t accesses = 0;    // without these:
    uint32_t copies = 0;      // cp.async, and arrivals that wait for them; no fence does
    Cycle fence = 0;          // latency of the fence that waits for the accesses; 0: no fence waits
    bool has_stored = false;  // The warp has stored to global memory since its last fence among cores.
  };
  void count(const isa::OpRow& op);
  void take_news(Cycle now);
  void read_operands(uint32_t access_id, Cycle now);
  void complete(uint32_t access_id, Cycle now);
  void take_late_copies(Cycle now);
  void finish(uint32_t access_id, Cycle now);
  void deliver(const MemoryAccess& access, const IssueRow& row, Cycle now);
  uint32_t war_latency(const MemoryAccess& access) const {
    const LsuParams& lsu = core_.params.lsu;
    return access.lines.lines().empty() ? lsu.shared_war_latency : lsu.war_latency;
  }
  Cycle turn_end(Cycle now) const { return turn_ ? (now / turn_ + 1) * turn_ : 0; }

  const CoreParts core_;
  Lsu& lsu_;
  AccessLines lines_;
  const Cycle turn_;
  const bool holds_operands_;
  std::vector<Pending> pending_;  // one per slot
  const std::unique_ptr<AsyncCopies> copies_;
  SubwarpUnit* const subwarps_;
};

}  // namespace glint::core
