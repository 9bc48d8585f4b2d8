// Reads what `glint lab` computed, and writes the report's sections about experiments.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace glint::report {

inline constexpr const char* kLabKind = "experiment";
inline constexpr int kLabSchema = 1;

// Returns the document of a lab.json. `name` stands for the file in messages. Throws UserError when the text
// is no experiment of this version of Glint.
nlohmann::ordered_json read_lab(const std::string& text, const std::string& name);

// Returns the sections for data["labs"], a list, or "" without it. The script puts the figures into them.
// Throws UserError for a damaged document.
std::string lab_sections(const nlohmann::ordered_json& data);

}  // namespace glint::report
