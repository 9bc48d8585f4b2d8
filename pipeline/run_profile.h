// Watching a timing run: what each instruction cost, and how the machine was used as time went by.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "base/profile_table.h"
#include "base/types.h"
#include "core/image.h"

namespace glint::pipeline {

class TimingMachine;

struct Observation {
  bool profile = false;  // by instruction
  Cycle sample = 0;      // interval of the time series, in cycles; 0: none
};

// Before the machine runs.
void observe(TimingMachine& machine, const Observation& what);

// After the run, of all cores together. One row an instruction that cost anything, in program order, and a last one for
// the cycles that had no warp. Without a profile: no rows.
ProfileTable profile_of(const TimingMachine& machine, const core::Image& image);

// After the run. One row an interval; the last one may be shorter.
SeriesTable series_of(TimingMachine& machine, Cycle interval);

}  // namespace glint::pipeline
