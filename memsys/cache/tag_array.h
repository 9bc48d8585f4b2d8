// Models the tags of a sectored cache, which is set-associative or fully associative.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "base/types.h"
#include "memsys/cache/line_table.h"
#include "memsys/replacement.h"

namespace glint {
template <class Interface>
struct PolicyChoice;
}

namespace glint::mem {

struct CacheShape {
  uint32_t sets = 1, ways = 1, line_bytes = 128;
};
// Returns the shape of a cache of `bytes`. With 0 ways it is fully associative: one set has all lines.
CacheShape cache_shape(uint64_t bytes, uint32_t ways, uint32_t line_bytes);

// One hash table finds a line in any organisation, and a policy chooses which line makes way. Each sector is
// a bit of a byte, so a line has at most 8 sectors of 32 bytes.
class TagArray {
 public:
  static constexpr uint32_t kNone = LineTable::kNone;
  using Line = CacheLine;

  TagArray(const CacheShape& shape, const PolicyChoice<Replacement>& replacement);

  uint32_t find(Address address) const { return has_index_ ? index_.find(address) : find_in_set(address); }
  Line& line(uint32_t slot) { return lines_[slot]; }
  const Line& line(uint32_t slot) const { return lines_[slot]; }

  uint32_t num_lines() const { return uint32_t(lines_.size()); }
  uint32_t slot_of(const Line& line) const { return uint32_t(&line - lines_.data()); }

  // Returns the line that insert(address) would replace. There may be none where lines are held; has_victim()
  // says whether there is one.
  const Line& victim(Address address) const { return lines_[victim_of(address)]; }
  bool has_victim(Address address) const { return victim_of(address) != kNone; }

  // Replaces the victim by the line at `address`, which must be absent. The new line has no valid sectors;
  // the caller sets at least one.
  Line& insert(Address address) {
    const uint32_t slot = victim_of(address);
    Line& line = lines_[slot];
    if (line.used()) leave(slot);
    line.key = line_key(address);
    line.valid = line.dirty = 0;
    if (has_index_) index_.insert(address, slot);
    replacement_->filled(slot);
    return line;
  }

  // Inserts the line, if it is absent, in a cache whose lines are present whole.
  void keep(Address address) {
    if (find(address) == kNone) insert(address).valid = 1;
  }

  // Removes sectors of the line, and the line itself when no sector is left.
  void drop(uint32_t slot, uint8_t sectors) {
    Line& line = lines_[slot];
    line.valid &= uint8_t(~sectors);
    line.dirty &= uint8_t(~sectors);
    if (line.used()) return;
    leave(slot);
    replacement_->emptied(slot);
  }

  // Brings what find(), victim() and touch() need for the line near to the host's core.
  void prefetch(Address address) const {
    if (has_index_) return;
    const uint32_t set = set_of(address), first = set * shape_.ways;
    replacement_->prefetch(set);
    for (uint32_t i = 0; i < shape_.ways; i += 64 / sizeof(Line)) __builtin_prefetch(&lines_[first + i]);
    __builtin_prefetch(&lines_[first + shape_.ways - 1]);
  }
  // Notes that an access found its line in the slot.
  void touch(uint32_t slot) { replacement_->touched(slot); }

 private:
  uint32_t victim_of(Address address) const { return replacement_->victim(set_of(address), lines_); }
  // Returns the set of a line. Model: a multiplicative hash spreads power-of-two strides over the sets; real
  // hashes are not published.
  uint32_t set_of(Address address) const {
    if (shape_.sets == 1) return 0;
    const uint64_t hash = (address >> line_shift_) * 0x9e37'79b9'7f4a'7c15ull;
    return uint32_t(hash >> 32) % shape_.sets;
  }

  // Returns the slot of a line among those of its set. The loop has no branches, because nobody can foresee
  // in which way a line is.
  uint32_t find_in_set(Address address) const {
    const uint32_t key = line_key(address), first = set_of(address) * shape_.ways;
    const Line* const lines = lines_.data() + first;
    uint32_t way = kNone;
    for (uint32_t i = 0; i < shape_.ways; ++i) way = lines[i].key == key ? i : way;
    return way == kNone ? kNone : first + way;
  }
  void leave(uint32_t slot) {
    if (has_index_) index_.erase(lines_[slot].address());
    lines_[slot].key = kNoLine;
  }

  // Choice: sets of up to this many ways are searched way by way.
  static constexpr uint32_t kMaxWaysSearched = 32;

  CacheShape shape_;
  uint32_t line_shift_;  // a line has 1 << line_shift_ bytes
  std::vector<Line> lines_;
  bool has_index_;  // Sets are large, so lines are found by index_. Otherwise sets are searched.
  LineTable index_;
  std::unique_ptr<Replacement> replacement_;
};

}  // namespace glint::mem
