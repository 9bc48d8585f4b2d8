// Draws random numbers that are the same on every host.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace glint {

// Is SplitMix64 (Steele, Lea, Flood 2014).
class SplitMix {
 public:
  explicit SplitMix(uint64_t seed) : state_(seed) {}
  // Returns a number below `bound`, which is not 0.
  uint32_t below(uint32_t bound) {
    uint64_t z = state_ += 0x9e37'79b9'7f4a'7c15ull;
    z = (z ^ (z >> 30)) * 0xbf58'476d'1ce4'e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d0'49bb'1331'11ebull;
    return uint32_t(((z ^ (z >> 31)) >> 32) * bound >> 32);
  }

 private:
  uint64_t state_;
};

}  // namespace glint
