// Shows sampled runs: what was sampled, the estimates with their intervals, and whether two of them differ.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace glint::report {

// Returns how sampled runs of the same work differ, each from the first one: a list of {"before", "after"}
// (places in `runs`, which page_data() has), "how" and "changes", with "name", "before", "after", "relative",
// "change", "low", "high" and "significant". Throws UserError when a run's sample.csv is damaged.
nlohmann::ordered_json page_sample_changes(const nlohmann::ordered_json& runs);

// Returns the section of the page of these runs, or "" when none is sampled.
std::string sample_section(const nlohmann::ordered_json& data);

}  // namespace glint::report
