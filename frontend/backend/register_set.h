// Holds a set of virtual registers, with one bit for each. Only stretches of registers that have members take
// memory, because a program of 100,000 registers has thousands of blocks, and few registers live in each.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "frontend/virtual_program.h"

namespace glint::frontend {

class RegisterSet {
 public:
  RegisterSet() = default;
  explicit RegisterSet(size_t registers) : chunk_of_((registers + kBits - 1) / kBits) {}

  bool contains(VirtualRegister r) const {
    const uint32_t chunk = chunk_of_[r / kBits];
    return chunk != 0 && ((chunks_[chunk - 1][r % kBits / 64] >> (r % 64)) & 1);
  }
  void insert(VirtualRegister r) {
    uint32_t& chunk = chunk_of_[r / kBits];
    if (chunk == 0) chunk = add({});
    chunks_[chunk - 1][r % kBits / 64] |= uint64_t{1} << (r % 64);
  }
  void erase(VirtualRegister r) {
    if (const uint32_t chunk = chunk_of_[r / kBits]; chunk != 0)
      chunks_[chunk - 1][r % kBits / 64] &= ~(uint64_t{1} << (r % 64));
  }
  bool unite(const RegisterSet& other);  // returns true when the set grew
  void intersect(const RegisterSet& other);
  void subtract(const RegisterSet& other);
  size_t size() const;

  // Calls visit(register) in ascending order.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (size_t i = 0; i < chunk_of_.size(); ++i) {
      if (chunk_of_[i] == 0) continue;
      const Chunk& chunk = chunks_[chunk_of_[i] - 1];
      for (size_t w = 0; w < chunk.size(); ++w)
        for (uint64_t bits = chunk[w]; bits; bits &= bits - 1)
          visit(VirtualRegister(i * kBits + w * 64 + size_t(std::countr_zero(bits))));
    }
  }

 private:
  static constexpr size_t kBits = 512;
  using Chunk = std::array<uint64_t, kBits / 64>;
  uint32_t add(const Chunk& chunk) {
    chunks_.push_back(chunk);
    return uint32_t(chunks_.size());
  }

  std::vector<uint32_t> chunk_of_;  // from 1 on; 0: the stretch has no member
  std::vector<Chunk> chunks_;
};

}  // namespace glint::frontend
