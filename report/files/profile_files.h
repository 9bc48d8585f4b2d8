// The files of a profile and of a time series: tables for spreadsheets, stacks for flame graphs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/profile_table.h"
#include "report/files/call_tree.h"

namespace glint::report {

// The rows of each source line added up, by file and line. Instructions of unknown lines are left out.
std::vector<ProfileRow> by_line(const ProfileTable& profile);

// profile.csv: a row an instruction, then a row a source line, one for cycles without a warp; told apart by
// the first column.
std::string profile_csv(const ProfileTable& profile);

// profile.folded: "stage;main;file:line;function;file:line;reason cycles", a line for each that is not zero:
// what flame graph tools read. Calls are those that the compiler kept; where it did not, those of CallTree;
// without `text_of`, or where it knows no text, the line stands alone.
std::string profile_folded(
    const ProfileTable& profile,
    const CallTree::TextOf& text_of = [](const std::string&) { return std::nullopt; });

// series.csv: a row an interval.
std::string series_csv(const SeriesTable& series);

// What profile_csv() wrote: its instructions. `name` stands in messages; UserError when it is something else.
ProfileTable parse_profile(const std::string& text, const std::string& name);

}  // namespace glint::report
