// Gives the children of a node slots, so that a ray visits them roughly from front to back without sorting.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "rtunit/structure/structure.h"

namespace glint::rt {

// Bit a of a slot's number says that a child there lies on the upper side of axis a. A ray with the signs
// `octant` (bit a: it goes down axis a) visits the slots by rising `slot ^ octant`.
inline constexpr uint32_t kSlots = 8;

// Returns the slot of each of up to eight boxes. The sum over all boxes of (centre - centre of the node) *
// (the slot's direction) is the largest possible; of equal sums one is always chosen in the same way. Ylitie,
// Karras and Laine 2017 look for this sum with the auction algorithm. Choice: a table of all
// sets of slots gives it exactly, in at most 1024 steps a node.
inline std::array<uint8_t, kSlots> octant_slots(std::span<const Bounds> boxes) {
  std::array<std::array<double, 3>, kSlots> centre;
  Bounds all = boxes[0];
  for (size_t i = 0; i < boxes.size(); ++i)
    for (size_t a = 0; a < 3; ++a) {
      centre[i][a] = (double(boxes[i].low[a]) + boxes[i].high[a]) / 2;
      if (boxes[i].low[a] < all.low[a]) all.low[a] = boxes[i].low[a];
      if (boxes[i].high[a] > all.high[a]) all.high[a] = boxes[i].high[a];
    }
  const auto gain = [&](size_t box, uint32_t slot) {
    double sum = 0;
    for (size_t a = 0; a < 3; ++a) {
      const double off = centre[box][a] - (double(all.low[a]) + all.high[a]) / 2;
      sum += slot >> a & 1 ? off : -off;
    }
    return sum;
  };
  // best[set] is the largest sum of the first popcount(set) boxes in the slots of `set`, and last[set] the
  // slot of the last of them.
  std::array<double, 1u << kSlots> best{};
  std::array<uint8_t, 1u << kSlots> last{};
  uint32_t chosen = 0;
  for (uint32_t set = 1; set < best.size(); ++set) {
    const auto count = size_t(std::popcount(set));
    if (count > boxes.size()) continue;
    bool is_first = true;
    for (uint32_t rest = set; rest; rest &= rest - 1) {
      const auto slot = uint32_t(std::countr_zero(rest));
      const double sum = best[set & ~(1u << slot)] + gain(count - 1, slot);
      if (is_first || sum > best[set]) best[set] = sum, last[set] = uint8_t(slot);
      is_first = false;
    }
    if (count == boxes.size() && (chosen == 0 || best[set] > best[chosen])) chosen = set;
  }
  std::array<uint8_t, kSlots> out{};
  for (size_t i = boxes.size(); i-- > 0; chosen &= ~(1u << last[chosen])) out[i] = last[chosen];
  return out;
}

}  // namespace glint::rt
