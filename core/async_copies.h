// Follows the asynchronous copies of a core's warps, and what waits for them: warps, and arrivals at
// barriers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/core_parts.h"
#include "core/mbarrier_unit.h"

namespace glint::core {

// Counts one warp's copies between issue and completion, by group. Model: the seven youngest committed groups
// are told apart, so a wait that lets more of them be under way waits for older ones.
class CopyGroups {
 public:
  // Counts a copy of the open group, whose number it returns.
  uint32_t start();
  void commit();
  void end(uint32_t group);
  // Returns the copies under way but for those of the open group and of the `but` youngest committed ones.
  uint32_t num_before(uint32_t but) const;

 private:
  static constexpr uint32_t kGroups = 8;
  std::array<uint16_t, kGroups> count_{};  // by number of the group
  uint32_t open_ = 0, older_ = 0;          // the group that is open, and the copies of groups before these
};

// A copy is an access that fills no register. It takes the way of a load, and a turn of shared memory as a
// store does; nobody waits for it but who asks. Model: its turn in shared memory comes before its way to the
// L1 and not behind it, and groups belong to warps and not to threads, as on hardware.
//
// An arrival that waits for copies is an access to shared memory that does not end before them.
class AsyncCopies {
 public:
  // Returns null when the program has no copies.
  static std::unique_ptr<AsyncCopies> make(const CoreParts& core, MbarrierUnit* barriers, uint32_t accesses);
  AsyncCopies(const CoreParts& core, MbarrierUnit* barriers, uint32_t accesses);

  void start_warp(uint32_t slot) { slots_[slot] = {}; }
  // Notes that the warp has issued a copy, or an arrival that waits for copies, which is access `id`.
  void start(uint32_t slot, uint32_t id, const exec::Issued& issued);
  // Ends a group of copies, or lets the warp wait for groups.
  void order(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now);
  // Notes that memory has done its part of an access, which has reached the registers or shared memory at
  // `late_until`. Returns false when the access ends later: due() or take_ended() says when.
  bool end(uint32_t id, Cycle late_until, Cycle now);
  // Return an access that now ends, too, which end() has not let end.
  std::optional<uint32_t> take_ended();
  std::optional<uint32_t> due(Cycle now);
  // Returns the earliest cycle in which due() has an access, or kNever.
  Cycle next_event() const;

 private:
  static constexpr uint32_t kNone = ~0u;
  struct Slot {
    CopyGroups groups;
    uint32_t under_way = 0;     // copies
    uint32_t arrivals = kNone;  // the youngest arrival that has not ended
    uint32_t but = kNone;       // The warp waits for all groups but these; kNone: it does not.
    Cycle latency = 0;          // of that wait
  };
  struct Access {
    uint32_t slot = 0, pc = 0;
    uint32_t group = 0;     // of a copy
    uint64_t number = 0;    // order of issue
    uint32_t left = 0;      // copies that an arrival still waits for
    uint32_t next = kNone;  // the arrival of the warp before it
    bool is_copy = false, is_through = false;
    LaneMask lanes = 0;
    isa::Access places{};  // the barriers of an arrival
  };
  struct Late {
    uint32_t id;
    Cycle at;
  };
  void end_copy(const Access& copy, Cycle now);
  void arrive(uint32_t id, Cycle now);

  const CoreParts core_;
  MbarrierUnit* const barriers_;
  std::vector<Slot> slots_;
  std::vector<Access> accesses_;  // by number in the load-store unit's table
  std::vector<Late> late_;        // copies whose last words come with the end of the turn
  std::vector<uint32_t> ended_;
  uint64_t num_issued_ = 0;
};

}  // namespace glint::core
