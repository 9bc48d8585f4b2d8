// Writes a characterisation as one JSON document, from which `glint report` draws figures and writes tables.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "report/characterize/characterization.h"

namespace glint::report {

// Says where the numbers come from.
struct CharacterizationSource {
  std::string name;     // a directory or file
  std::string version;  // version of Glint
};

// Returns {"kind": "characterization", "schema", "workloads", "eigenvalues", "kept", "joins", "leaves",
// "clusters", "axes", ...}: the numbers of characterization_files(), to the same bits.
// docs/characterization.md has the fields, and read_characterization() of report/page/suite.h checks kind and
// schema.
nlohmann::ordered_json characterization_json(const Characterization& result,
                                             const CharacterizationSource& source);

}  // namespace glint::report
