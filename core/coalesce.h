// Merges the addresses of a warp's lanes into sectors of cache lines.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "base/types.h"
#include "exec/image.h"
#include "exec/texel_list.h"
#include "exec/warp_context.h"
#include "isa/op_row.h"
#include "memsys/request.h"

namespace glint::core {

// The widest access has all texels of 32 lanes, each in a line of its own.
inline constexpr uint32_t kMaxLines = exec::kMaxTexels * kLanes;

// No member has an initialiser: a list has room for many lines, and few of them are ever touched.
struct LineSectors {
  Address line;                        // physical
  uint8_t sectors;                     // bit i: sector i
  uint8_t atomic_lanes, atomic_turns;  // of an atomic (count_turns())
  mem::WordMask words;                 // the parts, of 32, that are touched as a whole
  LaneMask lanes;                      // lanes that touch the line
  mem::AtomicLanes atomic() const { return {atomic_lanes, atomic_turns, false}; }
};

// Holds the lines that one warp instruction touches, in the order of their first lane.
class LineList {
 public:
  static constexpr uint32_t kRowBytes = uint32_t(kLanes) * 4;

  explicit LineList(uint32_t line_bytes)
      : mask_(line_bytes - 1), part_shift_(uint32_t(std::countr_zero(line_bytes)) - 5) {}
  void clear() { count_ = last_ = 0; }
  // Adds [physical, physical + bytes), which `lane` touches.
  void add(Address physical, uint32_t bytes, int lane) {
    // Most accesses of a lane lie in one sector.
    if (physical % mem::kSectorBytes + bytes <= mem::kSectorBytes) [[likely]]
      add_in_sector(physical, bytes, lane);
    else
      add_by_sector(physical, bytes, lane);
  }
  // Adds the 4-byte words of a row of kRowBytes, of which each lane touches the one with its number.
  void add_row(Address physical, LaneMask lanes);
  std::span<const LineSectors> lines() const { return {lines_.data(), count_}; }
  uint32_t num_sectors() const;
  // Adds what `later` touches, if it has the same lines in the same order. Otherwise it changes nothing and
  // returns false.
  bool merge(const LineList& later);
  void set_atomic(size_t line, uint8_t lanes, uint8_t turns) {
    lines_[line].atomic_lanes = lanes;
    lines_[line].atomic_turns = turns;
  }
  Address offset(Address physical) const { return physical & mask_; }  // offset in its line

 private:
  void add_in_sector(Address physical, uint32_t bytes, int lane) {
    const Address offset = physical & mask_;
    LineSectors& line = at_line(physical - offset);
    line.sectors |= uint8_t(1u << offset / mem::kSectorBytes);
    line.words |= words_of(offset, bytes);
    line.lanes |= LaneMask{1} << lane;
  }
  void add_by_sector(Address physical, uint32_t bytes, int lane);
  // Returns the entry of a line, and makes it when the line is new. Neighbouring lanes mostly share a line,
  // so the line that was used last is tried first.
  LineSectors& at_line(Address line) {
    return count_ > 0 && lines_[last_].line == line ? lines_[last_] : other_line(line);
  }
  LineSectors& other_line(Address line);
  // Returns the parts of a line that lie as a whole in the `bytes` bytes from `offset` on.
  mem::WordMask words_of(Address offset, uint32_t bytes) const {
    const uint64_t begin = (offset + (uint64_t{1} << part_shift_) - 1) >> part_shift_;
    const uint64_t end = (offset + bytes) >> part_shift_;
    return begin < end ? mem::WordMask((uint64_t{1} << end) - (uint64_t{1} << begin)) : 0;
  }

  Address mask_;         // line size - 1
  uint32_t part_shift_;  // shift to one of the 32 parts of a line
  uint32_t count_ = 0, last_ = 0;
  std::array<LineSectors, kMaxLines> lines_;  // Entries from count_ on are not initialised.
};

// Says where the lanes' stacks lie in physical memory. Word w of lane l of warp slot s is at base + ((s *
// words + w) * 32 + l) * 4, so that lanes at the same offset share lines. With `by_thread` a lane's words lie
// one after another, and its hit attributes behind them; records of rays lie behind the stacks of all slots.
struct LocalLayout {
  // Vulkan-Sim's allocations begin at multiples of 256 B. It gives no record back; here a core's records
  // begin again after so many (Choice: as those of rt.shortcuts.store_each_hit).
  static constexpr uint32_t kApart = 256, kRecords = 1 << 16, kAttributeBytes = 12, kRecordBytes = 32;

  Address base = 0;        // physical, of this core
  uint32_t words = 0;      // words per lane
  bool by_thread = false;  // core.local_by_thread
  uint32_t slots = 0;      // warp slots of the core

  uint64_t bytes_per_warp() const { return bytes_per_lane() * kLanes; }
  uint64_t bytes() const { return bytes_per_warp() * slots + (by_thread ? uint64_t{kRecords} * kApart : 0); }
  Address word(uint32_t slot, uint64_t word, int lane) const {
    return base + slot * bytes_per_warp() +
           (by_thread ? uint64_t(lane) * bytes_per_lane() + word * 4 : (word * kLanes + uint64_t(lane)) * 4);
  }
  Address attributes(uint32_t slot, int lane) const {
    return word(slot, 0, lane) + bytes_per_lane() - kApart;
  }
  Address record(uint64_t number) const {
    return base + slots * bytes_per_warp() + number % kRecords * kApart;
  }

 private:
  uint64_t bytes_per_lane() const {
    return by_thread ? (uint64_t{words} * 4 + kApart - 1) / kApart * kApart + kApart : uint64_t{words} * 4;
  }
};

// Adds the lines of loads and stores at `access.address` of `lanes`. The virtual addresses must be valid,
// which the executor has checked.
void coalesce_global(LineList& out, const mem::AddressSpace& memory, const isa::Access& access,
                     LaneMask lanes, uint32_t bytes);
void coalesce_local(LineList& out, const LocalLayout& layout, uint32_t warp_slot, const isa::Access& access,
                    LaneMask lanes, uint32_t bytes);

// Fills in the lanes and turns of an atomic in lines that coalesce_global() has made. A turn takes the lanes
// of a sector in order, up to the first lane whose word the turn already has. An H200's times follow this
// rule (docs/validation.md). Without `turns` each sector has one turn. Model: lanes of a reduction (not
// `returns`) that all meet in one word count as one lane. An assembler adds them up beforehand when it knows
// that their addresses are the same; here equal addresses at run time are enough.
void count_turns(LineList& lines, const mem::AddressSpace& memory, const isa::Access& access, uint32_t bytes,
                 bool turns, bool returns);

// Returns the largest number of different words in one bank (32 banks of 4 bytes; lanes that want one word
// share it) or, for atomics, the largest number of lanes; at least 1.
uint32_t bank_passes(const isa::Access& access, LaneMask lanes, uint32_t bytes, bool is_atomic);

// Returns how many times shared memory has to be read or written for a warp's load or store. Halves of a warp
// take turns where a lane has 8 bytes, and quarters where it has 16; a part takes its bank_passes(), one at
// least. A load has half as many parts where all pairs of neighbours, or of lanes two apart, have one
// address. This is what an H100 takes for 133 patterns of addresses, to the pass (bench/probes/shared.csv).
uint32_t shared_passes(const isa::Access& access, LaneMask lanes, uint32_t bytes, bool is_store);

// Does the same for an ldmatrix or a stmatrix: each matrix takes the bank_passes() of its eight rows. An H200
// takes 1.04, 2.03 and 4.03 cycles for one, two and four matrices, and 32.04 for four whose rows lie 128
// bytes apart (bench/probes/tensor_h200.csv).
uint32_t matrix_passes(const isa::Access& access, LaneMask lanes, uint32_t matrices, uint32_t bytes);

}  // namespace glint::core
