// Keeps for each line how soon it is expected to be used again, for the policies `srrip` and `drrip`.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "memsys/replacement.h"

namespace glint::mem {

// This is re-reference interval prediction with hit priority (Jaleel et al., ISCA 2010). A line that is used
// again is expected at once. When no line is expected latest, all lines of the set age together. An unused
// slot is taken first. Model: where the lines that are expected latest are held, the latest of the others
// makes way.
class Intervals {
 public:
  Intervals(const Replacement::Context& context, uint32_t bits)
      : ways_(context.ways),
        latest_(uint8_t((1u << bits) - 1)),
        expected_(size_t{context.sets} * context.ways, latest_) {}

  uint8_t latest() const { return latest_; }
  uint32_t set_of(uint32_t slot) const { return slot / ways_; }

  uint32_t victim(uint32_t set, std::span<const CacheLine> lines) const {
    const uint32_t first = set * ways_;
    if (const uint32_t unused = first_unused(lines, first, ways_); unused != Replacement::kNone)
      return unused;
    uint32_t best = Replacement::kNone;
    for (uint32_t slot = first; slot < first + ways_; ++slot)
      if (!lines[slot].held && (best == Replacement::kNone || expected_[slot] > expected_[best])) best = slot;
    return best;
  }
  // Ages the set until the line that made way is expected latest, and gives the new line its interval.
  void fill(uint32_t slot, uint8_t interval) {
    const auto set = expected_.begin() + ptrdiff_t(slot / ways_ * ways_);
    const uint8_t age = latest_ - expected_[slot];  // steps by which the set ages until this line is latest
    std::for_each(set, set + ways_, [&](uint8_t& line) { line = std::min<uint8_t>(line + age, latest_); });
    expected_[slot] = interval;
  }
  void touch(uint32_t slot) { expected_[slot] = 0; }
  void empty(uint32_t slot) { expected_[slot] = latest_; }

 private:
  const uint32_t ways_;
  const uint8_t latest_;
  std::vector<uint8_t> expected_;  // predicted re-reference interval, by slot
};

}  // namespace glint::mem
