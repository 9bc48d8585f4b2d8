// Writes the part of a report's document that its source view draws.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "base/profile_table.h"
#include "report/files/source_files.h"

namespace glint::report {

// Returns an object with these fields:
//  - `reasons`
//  - `files`: `path` and `text`, which is lines or null
//  - `programs`: `shader` and `stage`; `scopes` with function, caller, and file and line of its call; `isa`
//    with columns `text`, `file`, `line`, `spirv`, `scope`; `spirv` with columns `text`, `file`, `line` and
//    `first`, the number of its first line
//  - `counts`: a row for each instruction that ran, with program, index, issues, lanes, sectors, accesses,
//    ended, latency, and pairs of a reason's number and its cycles
//  - `no_warp`: cycles that belong to no instruction
// Throws UserError when the two arguments are of different runs.
nlohmann::ordered_json page_source(const ProfileTable& profile, const SourceMap& map);

}  // namespace glint::report
