// Handles rays that gather candidates before their shaders run (rtunit/any_hit_mode.h): tables, choices,
// counts.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "exec/warp_context.h"

namespace glint::exec {

// Counts what intersection and any-hit shaders had to do.
struct CandidateCounts {
  // Count the calls of such shaders, once per warp and shader, and the lanes that made them.
  uint64_t calls = 0, lanes = 0;
  // Count the candidates of ended traces (rtunit/traversal/candidate_table.h), and how often a ray stopped
  // because its table was full.
  uint64_t gathered = 0, dropped = 0, overflows = 0;
};

class Candidates {
 public:
  Candidates(const World& world, CandidateCounts& counts)
      : world_(world), counts_(counts), table_rows_(world.any_hit ? world.any_hit->table_rows() : 0) {}

  // Returns the lane's table in a level of traces, or null when the mode has no tables.
  rt::CandidateTable* table_of(TraceFrame& frame, int lane) const;
  // Chooses the candidate that each of the lanes presents to a shader.
  void present(WarpContext& warp, LaneMask gathered) const;
  // Counts what the tables of the innermost trace held, at the end of the trace.
  void count(const WarpContext& warp);

 private:
  const World& world_;
  CandidateCounts& counts_;
  const uint32_t table_rows_;  // rows of a table in the any-hit mode
};

}  // namespace glint::exec
