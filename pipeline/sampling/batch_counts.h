// Names what a timing machine counts that estimates are made of.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "base/types.h"

namespace glint::pipeline {

class TimingMachine;

enum class BatchCount : uint8_t {
  Cycles,
  Instructions,
  Nodes,
  L1Reads,
  L1Hits,
  L2Reads,
  L2Hits,
  DramClocks,
  DramBusy,
  Count
};
using BatchCounts = std::array<double, size_t(BatchCount::Count)>;
inline double at(const BatchCounts& counts, BatchCount which) {
  return counts[size_t(which)];
}

// Returns what the machine has counted up to now.
BatchCounts counts_of(const TimingMachine& machine, Cycle now);

// Returns the columns of sample.csv in which these counts stand, and those of a row: "cycles,instructions"
// and so on, and ",5,7".
std::string batch_columns();
std::string batch_cells(const BatchCounts& counts);

}  // namespace glint::pipeline
