// The page of a characterisation: the document that its figures are drawn from, and its tables, which read without script.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "report/characterize/characterization.h"
#include "report/page.h"

namespace glint::report {

// What the page says about where its numbers come from.
struct CharacterizationSource {
  std::string name;     // directory or file
  std::string version;  // of Glint
};

// {"kind": "characterization", "workloads", "eigenvalues", "kept", "joins", "leaves", "clusters", "axes", ...}; docs/characterization.md
// has the fields. `models`: models_json() of report/analytical, or null.
nlohmann::ordered_json characterization_data(const Characterization& result, const CharacterizationSource& source, const nlohmann::ordered_json& models);

// `parts.frame` is web/dist/characterization.html. UserError when it lacks a place.
std::string characterization_page(const Characterization& result, const nlohmann::ordered_json& data, const PageParts& parts);

}  // namespace glint::report
