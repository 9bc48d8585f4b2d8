// Spills values of very large programs before their registers are coloured, where more of them live at once
// than there are registers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "frontend/backend/interference.h"

namespace glint::frontend {

// Choice: a file whose graph would have more edges is relieved first. The time of colouring grows with the
// edges and, where most values do not fit, with the square of the values. 10 million edges take it 8 s, and
// no shader of an ordinary size has more than 1 million.
inline constexpr uint64_t kMostEdges = 3'000'000;

// Returns how many pairs of one file's values live at the same time, counted where one of them is defined.
uint64_t count_edges(const VirtualProgram& program, const Liveness& liveness, RegisterFile file);

// Does nothing when the file has at most `most_edges` edges. Otherwise it spills, going backwards through
// each block, the values that are cheapest for their length, until those that are left nearly fit everywhere.
// Moves between spilled values that need not be apart disappear. `unspillable` is as in SpillPlan.
void relieve(VirtualProgram& program, RegisterFile file, uint32_t max_registers, const Ops& ops,
             std::vector<bool>& unspillable, uint64_t most_edges = kMostEdges);

}  // namespace glint::frontend
