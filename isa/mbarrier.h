// Says what a barrier in shared memory holds, and what the rows with Effect::Mbarrier make of it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace glint::isa {

// Names the kinds of Effect::Mbarrier, in OpRow::detail. CopyArrive arrives when the earlier copies of the
// thread are done, and lets the phase wait for one arrival more until then. CopyArriveNoInc is one of the
// arrivals that the phase waits for anyway.
enum class MbarrierKind : uint16_t {
  Init,
  Inval,
  Arrive,
  ArriveDrop,
  TestWait,  // asks whether a phase has ended
  TryWait,   // does the same, and may let the warp wait for it
  CopyArrive,
  CopyArriveNoInc
};
constexpr bool asks_for_phase(MbarrierKind kind) {
  return kind == MbarrierKind::TestWait || kind == MbarrierKind::TryWait;
}
constexpr bool waits_for_copies(MbarrierKind kind) {
  return kind == MbarrierKind::CopyArrive || kind == MbarrierKind::CopyArriveNoInc;
}

// Holds a barrier of 64 bits (PTX ISA, "mbarrier"). Choice: PTX leaves the bits open. These differ from an
// H200's, which keeps barriers in use outside of the memory that loads see.
struct Mbarrier {
  static constexpr uint32_t kBits = 20, kMost = (1u << kBits) - 1;  // largest count (PTX ISA)
  static constexpr uint32_t kPendingShift = kBits;
  static constexpr uint64_t kThere = uint64_t{1} << 62, kPhase = uint64_t{1} << 63;

  uint32_t expected = 0, pending = 0;  // arrivals of the next phase, and those that this one still waits for
  bool phase = false;                  // parity of the number of phases that have ended
  bool is_there = false;               // mbarrier.init has run, and mbarrier.inval has not

  static constexpr Mbarrier of(uint64_t word) {
    return {uint32_t(word) & kMost, uint32_t(word >> kPendingShift) & kMost, (word & kPhase) != 0,
            (word & kThere) != 0};
  }
  constexpr uint64_t word() const {
    return expected | uint64_t{pending} << kPendingShift | (is_there ? kThere : 0) | (phase ? kPhase : 0);
  }
  // Takes `count` arrivals, at most as many as the phase waits for. The last one ends it.
  constexpr void arrive(uint32_t count) {
    pending -= count;
    if (pending != 0 || count == 0) return;
    phase = !phase;
    pending = expected;
  }
};

}  // namespace glint::isa
