// Holds a block of warps: the shared memory and the barriers that its warps have in common.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/types.h"
#include "isa/barrier.h"

namespace glint::exec {

struct WarpContext;

// PTX and Vulkan allow at most this many threads in a block, on every GPU of the last ten years.
inline constexpr uint32_t kMaxBlockThreads = 1024;
inline constexpr uint32_t kMaxBlockWarps = kMaxBlockThreads / uint32_t(kLanes);

using WarpMask = uint32_t;  // bit i: warp i of a block

// Holds one barrier between two completions. Arrivals are counted in warps, because PTX asks for thread
// counts that are multiples of a warp, and a warp arrives as a whole.
struct Barrier {
  uint32_t expected = 0;  // warps; 0: all warps of the block that have not ended
  uint32_t arrived = 0;
  WarpMask waiting = 0;  // arrived warps that wait
  uint32_t count = 0;    // bar.red: threads whose predicate is true
  uint32_t threads = 0;  // bar.red: threads that gave a predicate
};

// Holds a block. Choice: ended warps no longer take part in anything, so a barrier of all threads waits only
// for the others. PTX leaves this open, and hardware does the same.
class Block {
 public:
  void start(uint32_t index, std::array<uint32_t, 3> id, uint32_t num_warps, uint32_t shared_bytes);

  // Notes that warp `warp` comes to barrier `barrier`, which is to see `expected` warps. Returns false when
  // the warps that are already there expect another number.
  bool arrive(uint32_t barrier, uint32_t warp, uint32_t expected, bool waits);
  // Counts threads for bar.red, after arrive().
  void contribute(uint32_t barrier, uint32_t threads, uint32_t with_true);
  // Returns whether all warps that the barrier waits for have come.
  bool is_complete(uint32_t barrier) const;
  // Opens a complete barrier and returns what it saw. The warps in `waiting` go on.
  Barrier release(uint32_t barrier);
  void end(uint32_t warp);

  WarpMask live() const { return live_; }        // warps that have not ended
  WarpMask waiting() const { return waiting_; }  // live warps that wait at a barrier
  // Returns whether warps wait and nobody is left who could come.
  bool is_stuck() const { return live_ != 0 && live_ == waiting_; }

  uint32_t index() const { return index_; }
  const std::array<uint32_t, 3>& id() const { return id_; }
  uint32_t num_warps() const { return num_warps_; }

  std::vector<std::byte> shared;
  uint64_t ended_phases = 0;                         // phases of barriers in shared memory that have ended
  std::array<WarpContext*, kMaxBlockWarps> warps{};  // null when the machine has not started it yet

 private:
  uint32_t index_ = 0, num_warps_ = 0;
  std::array<uint32_t, 3> id_{};
  WarpMask live_ = 0, waiting_ = 0;
  std::array<Barrier, isa::kNumBarriers> barriers_{};
};

}  // namespace glint::exec
