// Writes the results of a characterisation as tables of comma-separated values.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "report/characterize/characterization.h"

namespace glint::report {

// Returns file names and contents in a fixed order: standardised.csv, dropped.csv, eigenvalues.csv,
// loadings.csv, scores.csv, linkage.csv (SciPy's matrix: two groups, distance, leaves), leaves.csv,
// subset.csv, metrics_chosen.csv, kiviat.csv. Numbers read back to the same bits.
std::vector<std::pair<std::string, std::string>> characterization_files(const Characterization& result);

}  // namespace glint::report
