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

// Holds how the estimates of two sampled runs differ.
struct SampleComparison {
  std::vector<SampleChange> changes;
  bool is_paired = false;    // They have timed the same blocks, or the same launches.
  bool of_launches = false;  // Launches were sampled, not the blocks of one.
};

// Returns the changes of the estimates that both sampled runs have. Where they have timed the same, the
// scatter of the differences between equal batches or launches is smaller than that of these, and the
// method's own error, which both runs share, is left out. Otherwise the intervals of both runs are combined.
// `csv_before` and `csv_after` are their files sample.csv. Throws UserError when one of these is none.
SampleComparison compare_samples(const RunRecord& before, const RunRecord& after,
                                 const std::string& csv_before, const std::string& csv_after);

// Returns a sentence that says how the runs were compared.
std::string how_compared(const SampleComparison& comparison);

// Returns a line for each change, and how they were compared.
std::string comparison_text(const SampleComparison& comparison);

}  // namespace glint::report
