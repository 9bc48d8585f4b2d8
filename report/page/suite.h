// Writes what the report says of whole suites: characterisations and models that other commands computed.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace glint::report {

constexpr const char* kCharacterizationKind = "characterization";  // kind of characterization.json
constexpr int kCharacterizationSchema = 1;

// Reads characterization.json as `glint characterize` writes it. Throws UserError when the text is something
// else, or is of another version. `name` is used in messages.
nlohmann::ordered_json read_characterization(const std::string& text, const std::string& name);

// Returns the sections "Characterisation" and "Models" for data["characterizations"] and data["models"],
// which are lists, or "" for empty ones. Each section has a place for its figures (class "drawn"), tables
// that read without script, and a warning when "differing", a number of runs, is not 0. An element {"source",
// "missing": COMMAND} becomes one line that says how to get the section. Throws UserError when a document
// lacks a field.
std::string suite_sections(const nlohmann::ordered_json& data);

}  // namespace glint::report
