// What a profile tells of each instruction and what a time series tells of each interval: plain tables for
// every writer. SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/program_listing.h"

namespace glint {

// What is counted of an instruction, but for the cycles by reason.
struct ProfileCounts {
  uint64_t issues = 0;    // warp instructions
  uint64_t lanes = 0;     // that executed them, summed
  uint64_t accesses = 0;  // of them, those that went to the L1
  uint64_t requests = 0;  // lines asked for by these
  uint64_t sectors = 0;   // of 32 B
  uint64_t ended = 0;     // accesses and traces that came back
  uint64_t latency = 0;   // issue to completion of these, cycles, summed

  ProfileCounts& operator+=(const ProfileCounts& more) {
    issues += more.issues;
    lanes += more.lanes;
    accesses += more.accesses;
    requests += more.requests;
    sectors += more.sectors;
    ended += more.ended;
    latency += more.latency;
    return *this;
  }
};

// An instruction, or all instructions of a source line.
struct ProfileRow : ProfileCounts {
  std::string shader, stage;  // both empty: cycles that belong to no instruction
  std::string file;           // as the compiler was given it; empty when unknown
  uint32_t line = 0;          // 0: unknown
  uint32_t index = 0;         // of the instruction in its shader
  std::string op;
  uint32_t program = 0;  // of ProfileTable::programs
  uint32_t spirv = 0;    // line of its SPIR-V, from 1; 0: unknown
  uint32_t scope = 0;    // of its program's scopes, from 1; 0: unknown
  std::vector<uint64_t>
      slots;  // cycles of schedulers, by reason as in ProfileTable::reasons; the first is issuing

  // Adds what was counted and the cycles of each reason; the row stays whose it is.
  template <class Slots>
  void add(const ProfileCounts& counts, const Slots& by_reason) {
    *this += counts;
    slots.resize(by_reason.size());
    for (size_t i = 0; i < by_reason.size(); ++i) slots[i] += by_reason[i];
  }
  uint64_t total() const {
    uint64_t sum = 0;
    for (const uint64_t n : slots) sum += n;
    return sum;
  }
};

struct ProfileTable {
  std::vector<std::string> reasons;
  std::vector<ProfileRow> rows;  // in program order; the slots of all rows are the cycles of all schedulers
  std::vector<ProgramListing> programs;  // what ran; empty when the profile comes from a file of its own
};

// One row an interval, `columns` long each.
struct SeriesTable {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
};

}  // namespace glint
