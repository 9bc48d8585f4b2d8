// A block of warps: the shared memory and the barriers that its warps have in common.
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

inline constexpr uint32_t kMaxBlockThreads = 1024;  // PTX and Vulkan on every GPU of the last ten years
inline constexpr uint32_t kMaxBlockWarps = kMaxBlockThreads / uint32_t(kLanes);

using WarpMask = uint32_t;  // bit i = warp i of a block

// One barrier between two completions. Arrivals are counted in warps: PTX asks for thread counts that are
// multiples of a warp, and a warp arrives as a whole.
struct Barrier {
  uint32_t expected = 0;  // warps; 0: all of the block that have not ended
  uint32_t arrived = 0;
  WarpMask waiting = 0;  // those of them that wait
  uint32_t count = 0;    // bar.red: threads whose predicate is true
  uint32_t threads = 0;  // bar.red: threads that gave one
};

// Choice: ended warps take part in nothing any more, so that a barrier of all threads waits for the others
// only. PTX leaves it open; the hardware does so.
class Block {
 public:
  void start(uint32_t index, std::array<uint32_t, 3> id, uint32_t num_warps, uint32_t shared_bytes);

  // Warp `warp` comes to barrier `barrier`, which is to see `expected` warps. False when the warps that are
  // there already expect another number.
  bool arrive(uint32_t barrier, uint32_t warp, uint32_t expected, bool waits);
  // Counts threads for bar.red, after arrive().
  void contribute(uint32_t barrier, uint32_t threads, uint32_t with_true);
  // All that the barrier waits for are there.
  bool is_complete(uint32_t barrier) const;
  // Opens a complete barrier and returns what it saw; the warps in `waiting` go on.
  Barrier release(uint32_t barrier);
  void end(uint32_t warp);

  WarpMask live() const { return live_; }        // warps that have not ended
  WarpMask waiting() const { return waiting_; }  // those of them that wait at a barrier
  // Warps wait, and nobody is left who could come.
  bool is_stuck() const { return live_ != 0 && live_ == waiting_; }

  uint32_t index() const { return index_; }
  const std::array<uint32_t, 3>& id() const { return id_; }
  uint32_t num_warps() const { return num_warps_; }

  std::vector<std::byte> shared;
  std::array<WarpContext*, kMaxBlockWarps> warps{};  // null where the machine has not started it yet

 private:
  uint32_t index_ = 0, num_warps_ = 0;
  std::array<uint32_t, 3> id_{};
  WarpMask live_ = 0, waiting_ = 0;
  std::array<Barrier, isa::kNumBarriers> barriers_{};
};

}  // namespace glint::exec
