// Knows when the operands of a scheduler's warps come, and hands out those that have come without looking at
// the others.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "base/types.h"

namespace glint::core {

// Holds one bit for each of up to 64 warps. Most operands come within a few cycles, so the next 64 cycles
// have a word each (a timing wheel). Warps that wait for longer lie apart, and enter the wheel when their
// cycle is near.
class OperandWheel {
 public:
  // Returns the warps whose operands were missing at the last advance().
  uint64_t missing() const { return missing_; }

  // Returns when the operands of `warp` come; kNever: nobody knows it yet.
  Cycle at(uint32_t warp) const { return at_[warp]; }

  // Notes that the operands of `warp` come in cycle `at`. kNever: nobody knows it yet.
  void set(uint32_t warp, Cycle at) {
    const uint64_t bit = uint64_t{1} << warp;
    if (missing_ & bit) [[unlikely]]
      take_out(warp);
    at_[warp] = at;
    missing_ = at > now_ ? missing_ | bit : missing_ & ~bit;
    if (at > now_) put_in(warp);
  }

  // Does the same for a warp whose operands are not missing, when `at` is later than the last advance().
  void put_back(uint32_t warp, Cycle at) {
    at_[warp] = at;
    missing_ |= uint64_t{1} << warp;
    put_in(warp);
  }

  // Goes on to cycle `now`, which may not be before that of the last call.
  void advance(Cycle now) {
    if (now - now_ == 1 && next_far_ == kNever) [[likely]]
      advance();
    else if (now != now_)
      skip_to(now);
  }

  // Returns a cycle before which no further operands come: the exact one, unless all warps wait for longer
  // than the wheel reaches.
  Cycle next() const { return cycles_ ? now_ + 1 + Cycle(std::countr_zero(from_next())) : next_far_; }

 private:
  static constexpr Cycle kCycles = 64;

  // Returns the cycles with warps: bit i stands for the cycle i + 1 after the present one.
  uint64_t from_next() const { return std::rotr(cycles_, int((now_ + 1) % kCycles)); }

  // Goes on to a later cycle.
  [[gnu::noinline]] void skip_to(Cycle now) {
    const Cycle elapsed = now - now_;
    uint64_t come = from_next();
    if (elapsed < kCycles) come &= (uint64_t{1} << elapsed) - 1;
    for (; come; come &= come - 1) {
      const auto cycle = size_t((now_ + 1 + Cycle(std::countr_zero(come))) % kCycles);
      missing_ &= ~due_[cycle];
      due_[cycle] = 0;
      cycles_ &= ~(uint64_t{1} << cycle);
    }
    now_ = now;
    if (next_far_ != kNever && next_far_ <= now + kCycles) [[unlikely]]
      bring_near();
  }

  // Goes on by one cycle while no warp lies apart.
  void advance() {
    const auto cycle = size_t(++now_ % kCycles);
    missing_ &= ~due_[cycle];
    due_[cycle] = 0;
    cycles_ &= ~(uint64_t{1} << cycle);
  }
  void put_in(uint32_t warp) {
    const uint64_t bit = uint64_t{1} << warp;
    const Cycle at = at_[warp];
    if (at - now_ <= kCycles) {
      due_[at % kCycles] |= bit;
      cycles_ |= uint64_t{1} << (at % kCycles);
    } else if (at != kNever) {
      far_ |= bit;
      next_far_ = std::min(next_far_, at);
    }
  }
  void take_out(uint32_t warp) {
    const uint64_t bit = uint64_t{1} << warp;
    const auto cycle = size_t(at_[warp] % kCycles);
    far_ &= ~bit;
    due_[cycle] &= ~bit;
    if (due_[cycle] == 0) cycles_ &= ~(uint64_t{1} << cycle);
  }
  void bring_near() {
    next_far_ = kNever;
    for (uint64_t rest = far_; rest; rest &= rest - 1) {
      const auto warp = uint32_t(std::countr_zero(rest));
      const uint64_t bit = uint64_t{1} << warp;
      far_ &= ~bit;
      if (at_[warp] > now_)
        put_in(warp);
      else
        missing_ &= ~bit;
    }
  }

  Cycle now_ = 0;
  uint64_t missing_ = 0;
  uint64_t cycles_ = 0;      // bit c: due_[c] has warps
  uint64_t far_ = 0;         // warps whose operands come after the cycles of the wheel
  Cycle next_far_ = kNever;  // no operands of `far_` come before
  std::array<uint64_t, kCycles>
      due_{};                   // by cycle modulo the wheel's size: the warps whose operands come then
  std::array<Cycle, 64> at_{};  // when the operands of each warp come
};

}  // namespace glint::core
