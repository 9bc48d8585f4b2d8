// Lays out statistics for the report: the tree of stats.json with the instances of a unit side by side.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>

namespace glint::report {

// Returns "gpu.core[*].blocks": [64, 64], "gpu.core[*].issue_slots::issued": [9, 8], "gpu.cycles": [100]. A
// histogram has a list of counts for each instance, without the empty bins at its end. A value that is 0 in
// every instance is the number 0. Adds unit, meaning and bins of each statistic that `docs` does not have
// yet.
nlohmann::ordered_json page_stats(const nlohmann::ordered_json& stats, nlohmann::ordered_json& docs);

}  // namespace glint::report
