// Source text with what each of its lines cost beside it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/profile_table.h"
#include "report/table.h"

namespace glint::report {

// The files of a profile with a share of its cycles, the costliest first.
struct FileShare {
  std::string file;
  double share = 0;  // of the cycles of all instructions
};
std::vector<FileShare> files_of(const ProfileTable& profile);

// A heading, then each line of `source` with its figures; without a source only the lines that have figures.
std::string annotate(const ProfileTable& profile, const std::string& file, const std::optional<std::string>& source,
                     const Terminal& terminal);

// Where the cycles of all schedulers went, by reason, the largest first: it adds up to 100 %.
std::string reason_table(const ProfileTable& profile, const Terminal& terminal);

}  // namespace glint::report
