// Estimates what it costs to keep values in memory and not in registers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <vector>

#include "frontend/backend/interference.h"

namespace glint::frontend {

inline constexpr float kNeverSpill = std::numeric_limits<float>::infinity();

// Holds the cost of each value in executed instructions. The cost is below 0 for a value that is saved and
// restored around more calls than it has accesses.
class SpillCosts {
 public:
  SpillCosts(const VirtualProgram& program, const Liveness& liveness, const std::vector<float>& weights);

  // Adds the costs of registers that the graph has merged. Values that must not spill get kNeverSpill.
  void merge(const InterferenceGraph& graph, const std::vector<bool>& unspillable);
  float of(VirtualRegister representative) const { return cost_[representative]; }

 private:
  std::vector<float> cost_;
};

}  // namespace glint::frontend
