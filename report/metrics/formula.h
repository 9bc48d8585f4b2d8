// Formulas over a finished run: what a derived metric is, as text that documents it and is what is computed.
//
//   sum(PATH) max(PATH) mean(PATH)   over all statistics whose path matches; '*' stands for any characters
//   but '.'
//                                    core. rt. l1. l2. dram. at its beginning are those of all instances:
//                                    gpu.core[*]. and so on a run of the functional machine gives what it
//                                    counts of these
//   run(NAME) config(KEY)            a number of run.json, a key of the configuration
//   numbers, + - * /, parentheses
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "report/files/run_record.h"

namespace glint::report {

// Absent when the run has no statistic or fact of a name, or when something is divided by zero.
// UserError when the text is no formula.
std::optional<double> evaluate(const std::string& formula, const RunRecord& run);

// Why evaluate() gave nothing, for a reader of the run.
std::string why_absent(const RunRecord& run);

// Every statistic's whole path that a formula names, for checking that there are such statistics.
std::vector<std::string> paths_in(const std::string& formula);

}  // namespace glint::report
