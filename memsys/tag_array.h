// The tags of a sectored cache with least-recently-used replacement, set-associative or fully associative.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "base/types.h"
#include "memsys/line_table.h"

namespace glint::mem {

// One hash table finds a line in any organisation; each set is a list from most to least recently used, so
// that 512 ways cost the same as 4. Sectors are bits of a byte: at most 8 sectors of 32 bytes in a line.
class TagArray {
 public:
  static constexpr uint32_t kNone = LineTable::kNone;

  struct Line {
    Address address = 0;
    uint8_t valid = 0;  // sectors present
    uint8_t dirty = 0;  // sectors newer than the level below, also those written only in part
    bool held = false;  // its data is on the way: never a victim
    uint32_t newer = kNone, older = kNone;
    bool used() const { return valid || dirty || held; }
  };

  TagArray(uint32_t sets, uint32_t ways, uint32_t line_bytes)
      : lines_(size_t(sets) * ways),
        newest_(sets),
        oldest_(sets),
        index_(lines_.size()),
        line_bytes_(line_bytes) {
    for (uint32_t set = 0; set < sets; ++set) {
      for (uint32_t way = 0; way < ways; ++way) {
        Line& line = lines_[set * ways + way];
        line.newer = way == 0 ? kNone : set * ways + way - 1;
        line.older = way + 1 == ways ? kNone : set * ways + way + 1;
      }
      newest_[set] = set * ways;
      oldest_[set] = set * ways + ways - 1;
    }
  }

  uint32_t find(Address address) const { return index_.find(address); }
  Line& line(uint32_t slot) { return lines_[slot]; }
  const Line& line(uint32_t slot) const { return lines_[slot]; }

  uint32_t slot_of(const Line& line) const { return uint32_t(&line - lines_.data()); }

  // The line that insert(address) would replace. With lines that are held: has_victim() first.
  const Line& victim(Address address) const { return lines_[oldest_free(set_of(address))]; }
  bool has_victim(Address address) const { return oldest_free(set_of(address)) != kNone; }

  // Replaces the victim by `address` (absent until now), most recently used, without valid sectors: the
  // caller sets at least one.
  Line& insert(Address address) {
    const uint32_t slot = oldest_free(set_of(address));
    Line& line = lines_[slot];
    if (line.used()) index_.erase(line.address);
    line.address = address;
    line.valid = line.dirty = 0;
    index_.insert(address, slot);
    touch(slot);
    return line;
  }

  // Makes a line whose sectors count as one present, if it is not.
  void keep(Address address) {
    if (find(address) == kNone) insert(address).valid = 1;
  }

  // The sectors are there no more; the line neither when none is left.
  void drop(uint32_t slot, uint8_t sectors) {
    Line& line = lines_[slot];
    line.valid &= uint8_t(~sectors);
    line.dirty &= uint8_t(~sectors);
    if (!line.used()) index_.erase(line.address);
  }

  void touch(uint32_t slot) {  // now the most recently used of its set
    Line& line = lines_[slot];
    if (line.newer == kNone) return;
    const uint32_t set = set_of(line.address);
    lines_[line.newer].older = line.older;
    (line.older == kNone ? oldest_[set] : lines_[line.older].newer) = line.newer;
    line.newer = kNone;
    line.older = newest_[set];
    lines_[newest_[set]].newer = slot;
    newest_[set] = slot;
  }

 private:
  uint32_t oldest_free(uint32_t set) const {
    uint32_t slot = oldest_[set];
    while (slot != kNone && lines_[slot].held) slot = lines_[slot].newer;
    return slot;
  }
  // Model: a multiplicative hash spreads power-of-two strides over the sets; real hashes are not published.
  uint32_t set_of(Address address) const {
    if (newest_.size() == 1) return 0;
    const uint64_t hash = (address / line_bytes_) * 0x9e37'79b9'7f4a'7c15ull;
    return uint32_t((hash >> 32) % newest_.size());
  }

  std::vector<Line> lines_;
  std::vector<uint32_t> newest_, oldest_;  // by set
  LineTable index_;
  uint32_t line_bytes_;
};

}  // namespace glint::mem
