// Holds what a profile tells of each instruction and a time series of each interval, as plain tables for
// every writer.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/program_listing.h"

namespace glint {

// Holds the counts of an instruction, without its cycles by reason.
struct ProfileCounts {
  uint64_t issues = 0;    // warp instructions
  uint64_t lanes = 0;     // lanes that executed the instruction, summed over issues
  uint64_t accesses = 0;  // issues that accessed the L1
  uint64_t requests = 0;  // cache lines that these accesses asked for
  uint64_t sectors = 0;   // 32 B sectors that these accesses asked for
  uint64_t ended = 0;     // accesses and traces that completed
  uint64_t latency = 0;   // cycles from issue to completion, summed over those that completed

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

// A row holds the counts of an instruction, or of all instructions of a source line.
struct ProfileRow : ProfileCounts {
  std::string shader, stage;  // both are empty for cycles that belong to no instruction
  std::string file;           // path that the compiler was given; empty when unknown
  uint32_t line = 0;          // 0: unknown
  uint32_t index = 0;         // number of the instruction in its shader
  std::string op;
  uint32_t program = 0;         // index into ProfileTable::programs
  uint32_t spirv = 0;           // line of its SPIR-V, from 1; 0: unknown
  uint32_t scope = 0;           // row of ProgramListing::scopes, from 1; 0: unknown
  std::vector<uint64_t> slots;  // scheduler cycles by ProfileTable::reasons; the first reason is issuing

  // Adds counts and the cycles of each reason. The row still names the same instruction afterwards.
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
  // The rows are in program order. Their slots add up to the cycles of all schedulers.
  std::vector<ProfileRow> rows;
  // The programs that ran. The list is empty when the profile comes from a file of its own.
  std::vector<ProgramListing> programs;
};

// Holds one row per interval; each row has as many values as `columns`.
struct SeriesTable {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
};

}  // namespace glint
