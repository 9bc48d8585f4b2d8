// Maps a line address to a small number by open addressing, for tags, MSHRs and sets of lines.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/types.h"
#include "memsys/request.h"

namespace glint::mem {

// The table probes linearly, is at most half full, and deletes by shifting cells back. There are no
// tombstones, so lookups never slow down. The table doubles when it holds more lines than ever
// before, and allocates only then.
class LineTable {
 public:
  static constexpr uint32_t kNone = ~0u;

  explicit LineTable(size_t expected = 16) { resize(std::bit_ceil(expected * 2 < 16 ? 16 : expected * 2)); }

  uint32_t find(Address line) const {
    const uint32_t key = line_key(line);
    for (size_t i = home(key);; i = (i + 1) & mask_) {
      if (cells_[i].key == key) return cells_[i].value;
      if (cells_[i].key == kNoLine) return kNone;
    }
  }
  // Inserts `line`, which must be absent.
  void insert(Address line, uint32_t value) {
    if (2 * (size_ + 1) > cells_.size()) grow();
    put({line_key(line), value});
    ++size_;
  }
  // Removes `line`, which must be present.
  void erase(Address line) {
    const uint32_t key = line_key(line);
    size_t hole = home(key);
    while (cells_[hole].key != key) hole = (hole + 1) & mask_;
    for (size_t i = (hole + 1) & mask_; cells_[i].key != kNoLine; i = (i + 1) & mask_) {
      // The cell at i may move to the hole when its home does not lie between them.
      if (((i - home(cells_[i].key)) & mask_) >= ((i - hole) & mask_)) cells_[hole] = cells_[i], hole = i;
    }
    cells_[hole].key = kNoLine;
    --size_;
  }
  size_t size() const { return size_; }

 private:
  struct Cell {
    uint32_t key, value;
  };

  // Returns the cell at which the search for a key begins. Fibonacci hashing takes the upper bits of a
  // product with 2^64 / golden ratio (Knuth, TAOCP 3, 6.4).
  size_t home(uint32_t key) const { return size_t((key * 0x9e37'79b9'7f4a'7c15ull) >> shift_); }
  void put(Cell cell) {
    size_t i = home(cell.key);
    while (cells_[i].key != kNoLine) i = (i + 1) & mask_;
    cells_[i] = cell;
  }
  void resize(size_t cells) {
    cells_.assign(cells, {kNoLine, 0});
    mask_ = cells - 1;
    shift_ = 64 - std::countr_zero(cells);
  }
  void grow() {
    std::vector<Cell> old = std::move(cells_);
    resize(old.size() * 2);
    for (const Cell& cell : old)
      if (cell.key != kNoLine) put(cell);
  }

  std::vector<Cell> cells_;
  size_t mask_ = 0, size_ = 0;
  int shift_ = 0;
};

}  // namespace glint::mem
