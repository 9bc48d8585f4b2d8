// Writes the files of a profile and of a time series: tables for spreadsheets, stacks for flame graphs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/profile_table.h"
#include "report/files/call_tree.h"

namespace glint::report {

// Returns the rows of each source line added up, by file and line. Instructions of unknown lines are left
// out.
std::vector<ProfileRow> by_line(const ProfileTable& profile);

// Returns profile.csv: a row for each instruction, then one for each source line, then one for cycles without
// a warp. The first column tells them apart.
std::string profile_csv(const ProfileTable& profile);

// Returns profile.folded, which has a line "stage;main;file:line;function;file:line;reason cycles" for each
// number that is not zero. Flame graph tools read this form. The calls are those that the compiler kept. When
// it kept none, CallTree finds them. Without `text_of`, or when it knows no text, the line stands alone.
std::string profile_folded(
    const ProfileTable& profile,
    const CallTree::TextOf& text_of = [](const std::string&) { return std::nullopt; });

// Returns series.csv, with a row for each interval.
std::string series_csv(const SeriesTable& series);

// Reads the instructions that profile_csv() wrote. `name` is used in messages. Throws UserError when the text
// is something else.
ProfileTable parse_profile(const std::string& text, const std::string& name);

}  // namespace glint::report
