// What the report says of whole suites of workloads: characterisations and models that other commands have
// computed.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace glint::report {

constexpr const char* kCharacterizationKind = "characterization";  // of characterization.json
constexpr int kCharacterizationSchema = 1;

// characterization.json as `glint characterize` writes it. UserError where the text is none, or another
// version's. `name` stands in messages.
nlohmann::ordered_json read_characterization(const std::string& text, const std::string& name);

// The sections "Characterisation" and "Models" for data["characterizations"] and data["models"], which are
// lists; "" for empty ones. Each has a place for its figures (class "drawn"), tables that read without
// script, and a warning where "differing", a number of runs, is not 0. An element {"source", "missing":
// COMMAND} is one line that says how to get the section. UserError where a document lacks a field.
std::string suite_sections(const nlohmann::ordered_json& data);

}  // namespace glint::report
