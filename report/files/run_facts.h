// Reads run.json, and tells the folders of runs from other folders.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace glint::report {

// Returns the JSON object that a file of a run holds. Throws UserError when it holds something else.
nlohmann::ordered_json json_object(const std::string& text, const std::string& path);

// Reads run.json, whatever the run's end. Throws UserError when the file cannot be read, is not a JSON
// object, or has a key whose value is of another type than write_run() writes.
nlohmann::ordered_json read_run_facts(const std::string& path);

// Returns whether `glint run` has written the run.json of a folder.
bool is_run_folder(const std::string& folder);

}  // namespace glint::report
