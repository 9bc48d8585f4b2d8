// Checks at the end of every timing run that what went in came out, and that every cycle has one reason.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::pipeline {

class TimingMachine;

// Holds two counts of different parts of the machine that are equal when nothing is lost or counted twice.
struct Balance {
  std::string what;
  uint64_t left = 0, right = 0;
};

// Returns the balances of a machine whose run has ended well. MemorySystem::check_drained() checks what the
// memory system holds.
std::vector<Balance> balances(const TimingMachine& machine);

// Returns a line for each balance that does not hold, or "" when all do.
std::string broken(const std::vector<Balance>& balances);

}  // namespace glint::pipeline
