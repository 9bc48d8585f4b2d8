// What has to balance at the end of every timing run: what goes in comes out, and every cycle has one reason.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::pipeline {

class TimingMachine;

// Two counts, of different parts of the machine, that are equal when nothing is lost or counted twice.
struct Balance {
  std::string what;
  uint64_t left = 0, right = 0;
};

// Of a machine whose run has ended well. What the memory system holds is checked by
// MemorySystem::check_drained().
std::vector<Balance> balances(const TimingMachine& machine);

// A line for each balance that does not hold; "" when all do.
std::string broken(const std::vector<Balance>& balances);

}  // namespace glint::pipeline
