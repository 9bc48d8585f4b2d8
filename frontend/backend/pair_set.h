// Holds a set of pairs of numbers without order, such as the edges of a graph: a triangle of bits in tiles,
// of which only those with a member take memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

namespace glint::frontend {

class PairSet {
 public:
  PairSet() = default;
  explicit PairSet(size_t numbers) {
    const size_t tiles = numbers / kSide + 1;
    tile_of_.resize(tiles * (tiles + 1) / 2);
  }

  bool contains(size_t a, size_t b) const {
    const Place at(a, b);
    const uint32_t tile = tile_of_[at.tile];
    return tile != 0 && ((tiles_[tile - 1][at.row] >> at.column) & 1);
  }
  void insert(size_t a, size_t b) {
    const Place at(a, b);
    uint32_t& tile = tile_of_[at.tile];
    if (tile == 0) {
      tiles_.emplace_back();
      tile = uint32_t(tiles_.size());
    }
    tiles_[tile - 1][at.row] |= uint64_t{1} << at.column;
  }
  size_t num_tiles() const { return tiles_.size(); }  // those that take memory

 private:
  static constexpr size_t kSide = 64;
  struct Place {
    Place(size_t a, size_t b) {
      const size_t high = std::max(a, b), low = std::min(a, b), i = high / kSide;
      tile = i * (i + 1) / 2 + low / kSide;
      row = high % kSide;
      column = low % kSide;
    }
    size_t tile, row, column;
  };

  std::vector<uint32_t> tile_of_;  // from 1 on; 0: the tile has no member
  std::deque<std::array<uint64_t, kSide>> tiles_;
};

}  // namespace glint::frontend
