// Writes what the report says of an application of the Vulkan driver: its time line, and its launches by
// cycles.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace glint::report {

// Returns the sections for data["applications"], a list, or "" without it. An element is {"source": folder,
// "index": read_application(), "links": {run directory: its report}}. They need no script.
std::string application_sections(const nlohmann::ordered_json& data);

// Returns the folders of the timed launches of an index that ended, those with the most cycles first.
std::vector<std::string> timed_folders(const nlohmann::ordered_json& index);

}  // namespace glint::report
