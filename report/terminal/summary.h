// Formats what a person wants to know of a run on one screen: time, instructions, caches, DRAM, RT unit,
// rays.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "report/terminal/table.h"

namespace glint::report {

// Holds one class of the instruction mix.
struct MixRow {
  std::string name;
  uint64_t count = 0;  // warp instructions executed
  // These are the core cycles from issue to completion, summed over the instructions. They are 0 in
  // functional runs.
  uint64_t latency = 0;
};

struct HitRate {
  uint64_t hits = 0, accesses = 0;
};

// Holds numbers of a timing run. Fractions are 0 to 1. What the machine cannot tell is absent, never zero.
struct TimingSummary {
  uint64_t cycles = 0;  // core cycles
  double clock_mhz = 0;
  uint32_t resident_warps = 0,  // warps of the launch that fit on a core
      warp_slots = 0;           // warp slots of a core
  std::string residency_limit;  // what is used up first, such as "registers"
  std::string memory_peaks;     // the best that the memory system could do, in one line
  HitRate l1_rt, l1_shader, l2;
  std::optional<double> dram_utilisation;  // data-bus cycles / DRAM cycles
  std::optional<double> dram_efficiency;   // data-bus cycles / DRAM cycles with a request pending
  std::optional<double> rt_occupancy;      // resident warps / warp slots, averaged over cycles with any
  std::optional<double> rt_efficiency;     // active rays / lanes of resident warps
};

// Holds what a sampled run estimates of the whole one.
struct SampleSummary {
  std::string about;  // what was sampled, without an end of line
  struct Row {
    std::string name, unit;
    double value = 0, low = 0, high = 0;  // with a 95 % interval
  };
  std::vector<Row> rows;  // none when the launch was ended early
};

struct Summary {
  std::string title;               // such as "WKND pt 128x128 2 spp on mobile"
  std::string note;                // what differs from the original scene; "" when nothing does
  std::vector<std::string> files;  // paths of written files, picture first
  uint64_t warp_instructions = 0;
  double simt_efficiency = 0;  // active lanes / 32, averaged over instructions
  std::vector<MixRow> mix;
  uint64_t rays = 0;
  double nodes_per_ray = 0;  // mean number of BVH nodes visited
  uint32_t bvh_depth = 0;    // levels of the deepest path, top and bottom structure together
  double wall_seconds = 0;
  std::optional<TimingSummary> timing;  // absent for a functional run
  std::optional<SampleSummary> sample;  // is shown in place of the counts
};

std::string format_summary(const Summary& summary, const Terminal& terminal);

}  // namespace glint::report
