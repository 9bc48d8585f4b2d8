// A characterisation as one JSON document: what `glint report` draws its figures and writes its tables from.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "report/characterize/characterization.h"

namespace glint::report {

// Where the numbers come from.
struct CharacterizationSource {
  std::string name;     // directory or file
  std::string version;  // of Glint
};

// {"kind": "characterization", "schema", "workloads", "eigenvalues", "kept", "joins", "leaves", "clusters",
// "axes", ...}: the numbers of characterization_files(), to the same bits; docs/characterization.md has the
// fields. read_characterization() of report/page/suite.h checks kind and schema.
nlohmann::ordered_json characterization_json(const Characterization& result,
                                             const CharacterizationSource& source);

}  // namespace glint::report
