// A tree of statistics as a flat list of rows: what line-based formats and `glint list stats` show.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
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

// The value at `path` (as in StatRow, bins of histograms apart), or `fallback` when there is none.
double stat_value(const stats::Group& root, const std::string& path, double fallback);

}  // namespace glint::report
