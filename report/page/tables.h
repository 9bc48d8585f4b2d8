// The numbers behind the report's figures as tables that read without script.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace glint::report {

constexpr size_t kMaxRunsInTables = 8;  // a column each; more would not fit a page
constexpr size_t kOpsInTables = 12;     // as in the figures, by their largest value; profile.csv has all

// Tables of breakdowns and histograms, summed over the instances of a unit, and of the profile's ops; what is
// 0 in every run is left out. `head` is the tables' first row, as wide as the runs, unit and meaning. data:
// the report's document with `runs` and `stat_docs`.
std::string figure_tables(const nlohmann::ordered_json& data, const std::string& head);

}  // namespace glint::report
