// Models the part of a core that regroups threads: warps come to it, wait for each other, and go on together.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/core_parts.h"
#include "core/memory_accesses.h"
#include "core/regrouping.h"
#include "core/reorder_stats.h"

namespace glint::core {

// A warp that has executed a *.reorder waits until all of its accesses have been answered. Then it joins the
// warps at the same instruction whose lanes meet at the same places. When these go, their threads change
// places, and the warps issue again when the moved state has been copied.
//
// Model: threads move through a crossbar of the core with all of their state, and not through memory. The
// bytes of a thread are its live registers and its stack; hit objects, ray queries and rays that have ended
// move with it at no cost. A thread's stack then lies where its new lane has it.
class ReorderUnit {
 public:
  // Returns null when the policy lets no warp come.
  static std::unique_ptr<ReorderUnit> make(const CoreParts& core, MemoryAccesses& memory);
  ReorderUnit(const CoreParts& core, MemoryAccesses& memory, std::unique_ptr<Reorder> policy);

  // Notes that the warp has executed a *.reorder. What its lanes said is still in the executor.
  void come(uint32_t slot, const exec::Issued& issued, Cycle now);
  // Takes warps whose accesses have been answered, and lets batches go. It is called after the units that
  // answer accesses.
  void tick(Cycle now) {
    if (coming_ | waiting_) run(now);
  }
  // Returns the earliest cycle after `now` with work of its own, or kNever. Answers are the events of others.
  Cycle next_event(Cycle now) const;

 private:
  struct Slot {
    std::array<uint64_t, kLanes> keys{};
    Cycle came = 0, ready = 0;  // when it came, and when its last result is there
    uint32_t pc = 0;
    uint32_t bytes = 0;  // of a thread
  };
  struct Batch {
    uint64_t slots = 0;  // 0: there is no such batch
    Cycle since = 0;     // when the first of its warps joined
  };

  void run(Cycle now);
  void join(uint32_t slot, Cycle now);
  Batch& batch_of(uint32_t slot);
  void go(Batch& batch, Cycle now);
  uint64_t move_threads(Cycle now);
  void count_keys(stats::Counter& keys, stats::Counter& warps);
  void end_call(uint32_t slot, Cycle done, Cycle now);
  bool all_wait() const { return uint32_t(std::popcount(waiting_)) == core_.warps.num_resident(); }
  exec::WarpContext& warp(uint32_t slot) { return core_.warps[slot].warp; }

  const CoreParts core_;
  MemoryAccesses& memory_;
  const ReorderParams& params_;
  const std::unique_ptr<Reorder> policy_;
  ReorderStats stats_;
  const std::vector<uint16_t> registers_;  // every entry of a scoreboard
  std::vector<Slot> slots_;
  std::vector<Batch> batches_;  // as many as there are slots
  uint64_t coming_ = 0;         // bit w: the warp of slot w waits for its own accesses
  uint64_t waiting_ = 0;        // bit w: the warp of slot w waits in a batch
  Cycle free_at_ = 0;           // first cycle in which the crossbar takes another batch
  Regrouping regrouping_;
  // These belong to the batch that goes.
  std::vector<uint32_t> members_;
  std::vector<Regrouping::Warp> warps_;
  std::vector<uint64_t> distinct_;
};

}  // namespace glint::core
