// Combines sets of registers word by word.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/register_set.h"

namespace glint::frontend {

bool RegisterSet::unite(const RegisterSet& other) {
  bool grew = false;
  for (size_t i = 0; i < chunk_of_.size(); ++i) {
    if (other.chunk_of_[i] == 0) continue;
    const Chunk& more = other.chunks_[other.chunk_of_[i] - 1];
    if (chunk_of_[i] == 0) {
      if (more == Chunk{}) continue;  // All its members were erased.
      chunk_of_[i] = add(more);
      grew = true;
      continue;
    }
    Chunk& mine = chunks_[chunk_of_[i] - 1];
    for (size_t w = 0; w < mine.size(); ++w) {
      const uint64_t all = mine[w] | more[w];
      grew |= all != mine[w];
      mine[w] = all;
    }
  }
  return grew;
}

void RegisterSet::intersect(const RegisterSet& other) {
  for (size_t i = 0; i < chunk_of_.size(); ++i) {
    if (chunk_of_[i] == 0) continue;
    Chunk& mine = chunks_[chunk_of_[i] - 1];
    if (other.chunk_of_[i] == 0) {
      mine = {};
      continue;
    }
    const Chunk& kept = other.chunks_[other.chunk_of_[i] - 1];
    for (size_t w = 0; w < mine.size(); ++w) mine[w] &= kept[w];
  }
}

void RegisterSet::subtract(const RegisterSet& other) {
  for (size_t i = 0; i < chunk_of_.size(); ++i) {
    if (chunk_of_[i] == 0 || other.chunk_of_[i] == 0) continue;
    Chunk& mine = chunks_[chunk_of_[i] - 1];
    const Chunk& less = other.chunks_[other.chunk_of_[i] - 1];
    for (size_t w = 0; w < mine.size(); ++w) mine[w] &= ~less[w];
  }
}

size_t RegisterSet::size() const {
  size_t bits = 0;
  for (const Chunk& chunk : chunks_)
    for (uint64_t word : chunk) bits += size_t(std::popcount(word));
  return bits;
}

}  // namespace glint::frontend
