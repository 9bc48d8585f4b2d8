// Says whether two sampled runs differ by more than chance.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "report/files/run_record.h"

namespace glint::report {

struct SampleChange {
  std::string name;
  double before = 0, after = 0;
  bool is_relative = false;              // change, low and high are shares of `before`; otherwise differences
  double change = 0, low = 0, high = 0;  // with a 95 % interval
  bool is_significant() const { return low > 0 || high < 0; }
};

// Returns whether a run is sampled.
bool is_sampled(const RunRecord& run);

// Returns the changes of the estimates that both sampled runs have. Runs with equal shares, seeds and parts
// of the machine have timed the same blocks: the scatter of the differences between equal batches is smaller
// than that of the batches, and the method's own error, which both runs share, is left out. Otherwise the
// intervals of both runs are combined. `csv_before` and `csv_after` are their files sample.csv. Throws
// UserError when one of these is none.
std::vector<SampleChange> sample_changes(const RunRecord& before, const RunRecord& after,
                                         const std::string& csv_before, const std::string& csv_after);

// Returns whether the runs have timed the same blocks.
bool is_paired(const RunRecord& before, const RunRecord& after);

// Returns a line for each change, and how they were compared.
std::string sample_changes_text(const std::vector<SampleChange>& changes, bool paired);

}  // namespace glint::report
