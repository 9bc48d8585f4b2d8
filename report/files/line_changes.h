// Compares what the source lines of two profiled runs cost. Lines are matched by their text, so that an edit
// above a line does not separate it from itself.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/profile_table.h"
#include "report/files/source_files.h"
#include "report/terminal/table.h"

namespace glint::report {

// Holds a line that cost something in one of two runs. A line number is 0 in a run that has no such line.
struct LineChange {
  std::string file;                // path in the first run, or in the second where only that has the file
  uint32_t before = 0, after = 0;  // line numbers
  std::string text;                // empty when it is not known
  uint64_t cost_before = 0, cost_after = 0;
};

// Says how the text of a file that both runs have differs between them.
struct FileDifference {
  std::string file;
  bool is_known = true;                    // false: a text is not known, so lines were matched by number
  size_t only_before = 0, only_after = 0;  // lines without a counterpart
};

struct LineComparison {
  std::vector<LineChange> lines;               // by file in the order of its cost in both runs, then by line
  std::vector<FileDifference> differ;          // files whose texts are not the same, or not known
  std::vector<std::string> unmatched;          // files that only one run has
  size_t files = 0;                            // files that both runs have
  uint64_t whole_before = 0, whole_after = 0;  // of all instructions
  uint64_t no_line_before = 0, no_line_after = 0;  // of instructions without a line
};

// Returns the cost of a row of a profile.
using CostOf = std::function<uint64_t(const ProfileRow&)>;
// Returns the cost that a measure counts: "cycles", "issues", "accesses", "requests", "sectors" or a reason.
// Throws UserError for others, because the means of two lines cannot be added.
CostOf cost_of(const std::string& measure, const ProfileTable& profile);

// Returns the pairs of lines (both from 1, both increasing) that the longest common sequence of two texts
// matches. A middle of more than 16 million pairs between the equal beginning and end stays unmatched.
std::vector<std::pair<uint32_t, uint32_t>> matched_lines(const std::vector<std::string>& before,
                                                         const std::vector<std::string>& after);

// Holds one run. A file of one run is that file of the other which has its path or, failing that, alone has
// its name.
struct ProfiledRun {
  const ProfileTable& profile;
  const SourceMap& map;
};
LineComparison compare_lines(const ProfiledRun& before, const ProfiledRun& after, const std::string& measure);

// Returns a table of the comparison's lines: cost in both runs, change and ratio. `top` of 0 prints all lines
// in order of the source; otherwise at most `top` lines that changed, the largest change first.
std::string line_changes_text(const LineComparison& comparison, const std::string& measure, size_t top);

}  // namespace glint::report
