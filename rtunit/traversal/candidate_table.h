// Holds the candidates that a ray has met and that no shader has decided yet. They are the ray's column of a
// warp's table in the deferred any-hit mode.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "rtunit/traversal/ray.h"

namespace glint::rt {

// Describes a non-opaque triangle that was hit, or a procedural primitive whose box was entered at `hit.t`.
struct Candidate {
  Hit hit;
  bool is_procedural = false;
  bool is_opaque = false;  // For a procedural primitive: its hits need no any-hit shader.
};

inline constexpr uint32_t kMaxTableRows = 32;  // Rows are bits of a mask.
// Choice: an entry is a sector of eight words. They hold t, two weights, kind and flags, instance leaf,
// geometry, primitive and record.
inline constexpr uint32_t kTableEntryBytes = 32;

// Says where entries lie in memory. Row r of lane l of warp slot w lies at base + ((w * rows + r) * 32 + l) *
// 32, so lanes that fill the same row share lines.
struct TableLayout {
  Address base = 0;   // physical, of this core
  uint32_t rows = 0;  // 0: no tables
  uint64_t bytes_per_warp() const { return uint64_t{rows} * kLanes * kTableEntryBytes; }
  Address entry(uint32_t warp_slot, uint32_t row, int lane) const {
    return base + ((uint64_t{warp_slot} * rows + row) * kLanes + uint64_t(lane)) * kTableEntryBytes;
  }
};

struct CandidateTable {
  std::vector<Candidate> row;  // The owner of the table sizes it. An entry stays in its row.
  uint32_t used = 0;           // bit r: row r holds a candidate
  uint32_t unwritten = 0;      // bit r: the RT unit has not sent it to memory yet
  // These counts begin at clear().
  uint32_t gathered = 0;   // candidates put in
  uint32_t dropped = 0;    // taken out undecided, because the ray had ended before them
  uint32_t overflows = 0;  // times the traversal stopped because the table was full

  void clear() { used = unwritten = gathered = dropped = overflows = 0; }
  bool is_full() const { return uint32_t(std::popcount(used)) == row.size(); }
  void add(const Candidate& candidate) {
    const auto free = uint32_t(std::countr_one(used));
    row[free] = candidate;
    used |= 1u << free;
    unwritten |= 1u << free;
    ++gathered;
  }
  // Returns the rows with candidates that the RT unit has not sent to memory yet, and takes them as sent.
  uint32_t take_unwritten() { return std::exchange(unwritten, 0) & used; }
  void drop(uint32_t rows) {
    dropped += uint32_t(std::popcount(used & rows));
    used &= ~rows;
  }
};

}  // namespace glint::rt
