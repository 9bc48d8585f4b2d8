// Writes what the report says of folders of runs: the points of a sweep, and what a bench could not complete.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace glint::report {

// Returns the sections for data["collections"], a list, or "" without it. An element is {"kind": "sweep",
// "launches", "frames" or "bench", "source": folder, "keys": swept keys, "points": [{"name", "directory",
// "link"}], "failed":
// [{"name", "reason"}]}. Points are runs of data["runs"]; the table of a sweep, or of the launches or frames
// of a run, has a row for each, with the values of the keys and the main metrics. A bench has a section when
// some of its workloads failed.
std::string collection_sections(const nlohmann::ordered_json& data);

}  // namespace glint::report
