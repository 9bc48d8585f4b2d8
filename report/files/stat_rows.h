// Flattens a tree of statistics to a list of rows, for line-based formats and `glint list stats`.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/stats.h"

namespace glint::report {

// Holds one scalar, one part of a breakdown, or one filled bin of a histogram.
struct StatRow {
  std::string path;            // "gpu.core0.rt.rays", "gpu.core0.stalls::memory", "gpu.core0.rt.depth::8-15"
  std::string value;           // shortest decimal that reads back to the same number
  std::string_view unit, doc;  // They live as long as the statistic.
};

// Holds what is known of a statistic without its values.
struct StatName {
  std::string path, unit, doc;
};

// Returns the rows depth first, in order of declaration. The root's own name is the first part of every path.
std::vector<StatRow> stat_rows(const stats::Group& root);

// Returns totals over the instances of units: counters and parts of breakdowns are added up, and of computed
// values the largest is taken. An instance's number in brackets reads [*], which patterns match as they match
// numbers. Histograms, and quotients of units with numbers, are left out. Rows have no doc, and are in order
// of first appearance.
std::vector<StatRow> stat_totals(const stats::Group& root);

// Returns every statistic once, without values, in order of first appearance. An instance's number in
// brackets reads [*]. Parts and bins are left out, and an empty histogram is included.
std::vector<StatName> stat_names(const stats::Group& root);

// Returns whether a path matches `pattern`, in which '*' stands for any characters except '.'.
bool path_matches(std::string_view pattern, std::string_view path);

// Returns the sum of the values whose path (as in StatRow, without bins of histograms) matches `pattern`, or
// nothing when no path does.
std::optional<double> stat_sum(const stats::Group& root, const std::string& pattern);

}  // namespace glint::report
