// A tree of statistics as a flat list of rows: what line-based formats and `glint list stats` show.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/stats.h"

namespace glint::report {

// One scalar, one part of a breakdown, or one filled bin of a histogram.
struct StatRow {
  std::string path;   // "gpu.core0.rt.rays", "gpu.core0.stalls::memory", "gpu.core0.rt.depth::8-15"
  std::string value;  // shortest decimal that reads back to the same number
  std::string unit, doc;
};

// Depth first, in order of declaration. The root's own name is the first part of every path.
std::vector<StatRow> stat_rows(const stats::Group& root);

// Every statistic once, without values: an instance's number in brackets reads [*], parts and bins are left
// out. A histogram that is empty is there too. In order of first appearance.
std::vector<StatRow> stat_names(const stats::Group& root);

// Whether a path is of `pattern`, in which '*' stands for any characters but '.'.
bool path_matches(std::string_view pattern, std::string_view path);

// The sum of the values whose path (as in StatRow, bins of histograms apart) matches `pattern`; absent when
// no path does.
std::optional<double> stat_sum(const stats::Group& root, const std::string& pattern);

}  // namespace glint::report
