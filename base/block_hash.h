// Hashes large blocks of bytes at the speed of memory, for keys of caches and for checks of their files.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "base/parallel_ranges.h"

namespace glint {

// Takes words of 8 bytes in turns of four, each into a state of its own, so that four multiplications are
// under way at a time. A step is that of FNV-1a (Fowler, Noll, Vo) with a factor of 64 bits, and folds the
// high half into the low half, because a multiplication carries bits only upwards. Equal bytes give equal
// hashes only if they are added in equal pieces. Bytes that somebody chose so that hashes meet are not its
// business.
class BlockHash {
 public:
  void add(std::string_view bytes) {
    const size_t size = bytes.size();
    for (; bytes.size() >= kTurn; bytes.remove_prefix(kTurn))
      for (size_t lane = 0; lane < kLanes; ++lane) step(lane, word(bytes.data() + lane * sizeof(uint64_t)));
    for (size_t lane = 0; bytes.size() >= sizeof(uint64_t); ++lane, bytes.remove_prefix(sizeof(uint64_t)))
      step(lane, word(bytes.data()));
    for (const char c : bytes) step(kLanes - 1, uint8_t(c));
    step(0, size);
  }
  // Return two hashes of all bytes that were added.
  uint64_t first() const { return joined(0); }
  uint64_t second() const { return joined(2); }

 private:
  static constexpr size_t kLanes = 4, kTurn = kLanes * sizeof(uint64_t);
  static constexpr uint64_t kFactor = 0x9e37'79b9'7f4a'7c15;  // 2^64 / golden ratio

  static uint64_t word(const char* from) {
    uint64_t word;
    std::memcpy(&word, from, sizeof word);
    return word;
  }
  static uint64_t mixed(uint64_t state, uint64_t word) {
    state = (state ^ word) * kFactor;
    return state ^ state >> 32;
  }
  void step(size_t lane, uint64_t word) { state_[lane] = mixed(state_[lane], word); }
  // Returns a hash of the states, beginning with that of `lane`.
  uint64_t joined(size_t lane) const {
    uint64_t hash = lane;
    for (size_t i = 0; i < kLanes; ++i) hash = mixed(hash, state_[(lane + i) % kLanes]);
    return hash;
  }

  std::array<uint64_t, kLanes> state_{1, 2, 3, 4};
};

// Returns a hash of bytes that are cut into parts of 8 MiB, which up to `threads` threads of the host hash
// side by side. It is the same at any number of threads.
inline uint64_t parted_hash(std::string_view bytes, uint32_t threads) {
  constexpr size_t kPart = 8 << 20;
  std::vector<uint64_t> parts((bytes.size() + kPart - 1) / kPart);
  parallel_ranges(bytes.size(), kPart, threads, [&](size_t begin, size_t end) {
    BlockHash part;
    part.add(bytes.substr(begin, end - begin));
    parts[begin / kPart] = part.first();
  });
  BlockHash whole;
  whole.add({reinterpret_cast<const char*>(parts.data()), parts.size() * sizeof parts[0]});
  return whole.first();
}

}  // namespace glint
