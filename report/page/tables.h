// Lays out the numbers behind the report's figures as tables that read without script.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace glint::report {

constexpr size_t kMaxRunsInTables = 8;  // Each has a column, and more would not fit a page.
constexpr size_t kOpsInTables = 12;     // the ops with the largest values; profile.csv has all

// Returns tables of breakdowns and histograms, summed over the instances of a unit, and of the profile's ops.
// What is 0 in every run is left out. `head` is the tables' first row, as wide as the runs, unit and meaning.
// `data` is the report's document with `runs` and `stat_docs`.
std::string figure_tables(const nlohmann::ordered_json& data, const std::string& head);

}  // namespace glint::report
