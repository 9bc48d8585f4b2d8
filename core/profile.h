// Counts where a core's cycles go, by instruction. It runs only when asked for.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "base/profile_table.h"
#include "base/types.h"
#include "core/stall.h"

namespace glint::core {

struct InstructionCounts : ProfileCounts {
  std::array<uint64_t, size_t(Stall::Count)> slots{};  // cycles of schedulers
};

// Counts by instruction. Every cycle of a scheduler goes to the instruction that it issued or, when it issued
// none, to the one at which the warp nearest to issue waits. So the slots of all instructions add up to the
// core's issue slots, reason by reason.
class Profile {
 public:
  static constexpr uint32_t kNowhere = ~0u;  // There was no warp.

  Profile(size_t num_instructions, uint32_t schedulers)
      : counts_(num_instructions + 1), at_(schedulers, kNowhere) {}

  // Gives the scheduler's cycles to this instruction from now on.
  void point(uint32_t scheduler, uint32_t pc) { at_[scheduler] = pc; }
  void spend(uint32_t scheduler, Stall reason, uint64_t cycles) {
    const uint32_t pc = reason == Stall::NoWarp ? kNowhere : at_[scheduler];
    (pc < counts_.size() ? counts_[pc] : counts_.back()).slots[size_t(reason)] += cycles;
  }
  void issue(uint32_t scheduler, uint32_t pc, uint64_t lanes) {
    point(scheduler, pc);
    ++counts_[pc].issues;
    counts_[pc].lanes += lanes;
  }
  void access(uint32_t pc, uint64_t requests, uint64_t sectors) {
    ++counts_[pc].accesses;
    counts_[pc].requests += requests;
    counts_[pc].sectors += sectors;
  }
  void end(uint32_t pc, Cycle latency) {
    ++counts_[pc].ended;
    counts_[pc].latency += latency;
  }

  size_t num_instructions() const { return counts_.size() - 1; }
  const InstructionCounts& of(uint32_t pc) const { return counts_[pc]; }
  const InstructionCounts& nowhere() const { return counts_.back(); }

 private:
  std::vector<InstructionCounts> counts_;  // one per instruction, and the last for none
  std::vector<uint32_t> at_;
};

}  // namespace glint::core
