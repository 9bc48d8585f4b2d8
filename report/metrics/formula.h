// Evaluates formulas over a finished run. The text of a formula documents a derived metric and is what is
// computed.
//
//  - sum(PATH), max(PATH) and mean(PATH) go over all statistics whose path matches. '*' stands for any
//    characters except '.'. The beginnings core. rt. l1. l2. dram. stand for the paths of all instances, such
//    as gpu.core[*]. A run of the functional machine gives what it counts of these.
//  - run(NAME) is a number of run.json, and config(KEY) is a key of the configuration.
//  - Numbers, + - * / and parentheses join these.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "report/files/run_record.h"

namespace glint::report {

// Returns nothing when the run has no statistic or fact of a name, or when something is divided by zero.
// Throws UserError when the text is not a formula.
std::optional<double> evaluate(const std::string& formula, const RunRecord& run);

// Returns why evaluate() gave nothing, for a reader of the run.
std::string why_absent(const RunRecord& run);

// Returns the whole path of every statistic that a formula names, for checking that there are such
// statistics.
std::vector<std::string> paths_in(const std::string& formula);

}  // namespace glint::report
