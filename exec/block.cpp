// Implements the barriers of a block: who has arrived, and when they open.
// SPDX-License-Identifier: Apache-2.0
#include "exec/block.h"

#include <bit>
#include <cstddef>

#include "base/check.h"

namespace glint::exec {

void Block::start(uint32_t index, std::array<uint32_t, 3> id, uint32_t num_warps, uint32_t shared_bytes) {
  GLINT_CHECK(num_warps >= 1 && num_warps <= kMaxBlockWarps, "a block of {} warps", num_warps);
  index_ = index;
  id_ = id;
  num_warps_ = num_warps;
  live_ = num_warps == kMaxBlockWarps ? ~WarpMask{0} : (WarpMask{1} << num_warps) - 1;
  waiting_ = 0;
  ended_phases = 0;
  barriers_.fill({});
  warps.fill(nullptr);
  // Choice: shared memory starts as zeros; PTX and Vulkan leave it undefined.
  shared.assign(shared_bytes, std::byte{0});
}

bool Block::arrive(uint32_t barrier, uint32_t warp, uint32_t expected, bool waits) {
  Barrier& b = barriers_[barrier];
  if (b.arrived != 0 && b.expected != expected) return false;
  b.expected = expected;
  ++b.arrived;
  if (waits) {
    b.waiting |= WarpMask{1} << warp;
    waiting_ |= WarpMask{1} << warp;
  }
  return true;
}

void Block::contribute(uint32_t barrier, uint32_t threads, uint32_t with_true) {
  barriers_[barrier].threads += threads;
  barriers_[barrier].count += with_true;
}

bool Block::is_complete(uint32_t barrier) const {
  const Barrier& b = barriers_[barrier];
  if (b.arrived == 0) return false;
  return b.expected == 0 ? b.waiting == live_ : b.arrived >= b.expected;
}

Barrier Block::release(uint32_t barrier) {
  const Barrier out = barriers_[barrier];
  barriers_[barrier] = {};
  waiting_ &= ~out.waiting;
  return out;
}

void Block::end(uint32_t warp) {
  live_ &= ~(WarpMask{1} << warp);
}

}  // namespace glint::exec
