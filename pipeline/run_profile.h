// Watches a timing run: what each instruction cost, and how the machine was used as time went by.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "base/profile_table.h"
#include "base/types.h"
#include "exec/image.h"
#include "pipeline/trace_request.h"

namespace glint::pipeline {

// Returns a / b, or 0 where b is 0.
inline double ratio(double a, double b) {
  return b > 0 ? a / b : 0.0;
}

class TimingMachine;

// Says what to note of a run.
struct Observation {
  bool profile = false;  // True: the run makes a profile of each instruction.
  Cycle sample = 0;      // interval of the time series, in cycles; 0: none
  bool heat = false;     // True: the run makes maps of cost by pixel.
  TraceRequest trace{};

  // Returns the interval of counters for the time series or the trace, or 0 without either.
  Cycle interval() const { return sample || !trace.wanted ? sample : kTraceInterval; }
  static constexpr Cycle kTraceInterval = 1000;
};

// Names what is sampled of a core, with its L1 and RT unit, and of a partition.
enum OfCore : size_t { kInstructions, kRtWarps, kL1Reads, kL1Hits };
enum OfPartition : size_t { kL2Reads, kL2Hits, kDramBusy, kDramClocks };
using UnitSamples = std::vector<std::vector<uint64_t>>;
// Returns by how much `column` of all units has grown between two samples. The sample before the first is all
// zeros.
double growth(const std::vector<const UnitSamples*>& units, size_t sample, size_t column);

// Prepares the machine before it runs.
void observe(TimingMachine& machine, const Observation& what);

// Returns the profile of all cores together after the run. It has one row for each instruction that cost
// anything, in program order, and a last one for the cycles that had no warp. Without a profile it has no
// rows.
ProfileTable profile_of(const TimingMachine& machine, const exec::Image& image);

// Returns the time series after the run, with one row per interval. The last interval may be shorter.
SeriesTable series_of(TimingMachine& machine, Cycle interval);

}  // namespace glint::pipeline
