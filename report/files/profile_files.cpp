// Writes and reads the files of a profile.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/profile_files.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <fmt/format.h>
#include <map>
#include <set>
#include <utility>

#include "base/diagnostics.h"
#include "report/files/csv_field.h"

namespace glint::report {
namespace {

constexpr const char* kInstruction = "instruction";
constexpr const char* kLine = "line";
constexpr const char* kNone = "no_warp";
// These columns come before the reasons.
const std::vector<std::string> kColumns = {"by",       "stage",   "shader", "program", "file",  "line",
                                           "spirv",    "index",   "op",     "issues",  "lanes", "accesses",
                                           "requests", "sectors", "ended",  "latency", "cycles"};

std::string csv_line(const std::vector<std::string>& cells) {
  std::string out;
  for (size_t i = 0; i < cells.size(); ++i) out += (i ? "," : "") + csv_field(cells[i]);
  return out + "\n";
}

std::string row_text(const char* by, const ProfileRow& row) {
  std::vector<std::string> cells{by,
                                 row.stage,
                                 row.shader,
                                 std::to_string(row.program),
                                 row.file,
                                 std::to_string(row.line),
                                 std::to_string(row.spirv),
                                 std::to_string(row.index),
                                 row.op};
  for (const uint64_t n :
       {row.issues, row.lanes, row.accesses, row.requests, row.sectors, row.ended, row.latency, row.total()})
    cells.push_back(std::to_string(n));
  for (const uint64_t n : row.slots) cells.push_back(std::to_string(n));
  return csv_line(cells);
}

// Returns the cells of the line of a table that begins at `at`, and moves `at` behind it. Quoted cells may
// hold line ends.
std::vector<std::string> read_line(const std::string& text, size_t& at) {
  std::vector<std::string> cells(1);
  bool inside = false;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (inside && c == '"' && at + 1 < text.size() && text[at + 1] == '"') {
      cells.back() += text[++at];
    } else if (c == '"') {
      inside = !inside;
    } else if (!inside && c == ',') {
      cells.emplace_back();
    } else if (!inside && c == '\n') {
      ++at;
      break;
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

// Reads the numbers of a row from column `first` on.
class Numbers {
 public:
  Numbers(const std::vector<std::string>& cells, const std::string& name, int line)
      : cells_(cells), name_(name), line_(line) {}
  uint64_t at(size_t column) const {
    uint64_t value = 0;
    const std::string& cell = cells_[column];
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size())
      throw UserError({name_, line_, 0},
                      fmt::format("expected a number in column {}, found '{}'", column + 1, cell));
    return value;
  }

 private:
  const std::vector<std::string>& cells_;
  const std::string& name_;
  const int line_;
};

ProfileRow row_of(const std::vector<std::string>& cells, const Numbers& numbers) {
  ProfileRow row;
  row.stage = cells[1];
  row.shader = cells[2];
  row.program = uint32_t(numbers.at(3));
  row.file = cells[4];
  row.line = uint32_t(numbers.at(5));
  row.spirv = uint32_t(numbers.at(6));
  row.index = uint32_t(numbers.at(7));
  row.op = cells[8];
  size_t column = 9;
  for (uint64_t* to :
       {&row.issues, &row.lanes, &row.accesses, &row.requests, &row.sectors, &row.ended, &row.latency})
    *to = numbers.at(column++);
  for (size_t i = kColumns.size(); i < cells.size(); ++i) row.slots.push_back(numbers.at(i));
  return row;
}

}  // namespace

std::vector<ProfileRow> by_line(const ProfileTable& profile) {
  std::map<std::pair<std::string, uint32_t>, ProfileRow> lines;
  for (const ProfileRow& row : profile.rows) {
    if (row.line == 0) continue;
    ProfileRow& line = lines[{row.file, row.line}];
    line.file = row.file;
    line.line = row.line;
    line.add(row, row.slots);
  }
  std::vector<ProfileRow> out;
  for (auto& [place, row] : lines) out.push_back(std::move(row));
  return out;
}

std::string profile_csv(const ProfileTable& profile) {
  std::vector<std::string> columns = kColumns;
  columns.insert(columns.end(), profile.reasons.begin(), profile.reasons.end());
  std::string out = csv_line(columns);
  for (const ProfileRow& row : profile.rows) out += row_text(row.shader.empty() ? kNone : kInstruction, row);
  for (const ProfileRow& row : by_line(profile)) out += row_text(kLine, row);
  return out;
}

std::string profile_folded(const ProfileTable& profile, const CallTree::TextOf& text_of) {
  std::map<std::pair<std::string, std::string>, std::set<std::string>> files;  // files of each shader
  for (const ProfileRow& row : profile.rows)
    if (row.line) files[{row.stage, row.shader}].insert(row.file);
  std::map<std::pair<std::string, std::string>, CallTree> trees;
  for (const auto& [shader, names] : files)
    trees.emplace(shader, CallTree({names.begin(), names.end()}, text_of));
  std::map<std::string, uint64_t> stacks;  // sorted, so that the same profile gives the same text
  for (const ProfileRow& row : profile.rows) {
    std::vector<std::string> calls{row.shader};
    if (row.line)
      calls = row.program < profile.programs.size()
                  ? frames_of(profile.programs[row.program], row.scope, row.file, row.line)
                  : std::vector<std::string>();
    if (calls.empty()) calls = trees.at({row.stage, row.shader}).frames(row.file, row.line);
    const std::string frames =
        row.shader.empty() ? "gpu" : fmt::format("{};{}", row.stage, fmt::join(calls, ";"));
    for (size_t i = 0; i < row.slots.size(); ++i)
      if (row.slots[i]) stacks[frames + ";" + profile.reasons[i]] += row.slots[i];
  }
  std::string out;
  for (const auto& [stack, cycles] : stacks) out += fmt::format("{} {}\n", stack, cycles);
  return out;
}

std::string series_csv(const SeriesTable& series) {
  std::string out = csv_line(series.columns);
  for (const std::vector<double>& row : series.rows) out += fmt::format("{}\n", fmt::join(row, ","));
  return out;
}

ProfileTable parse_profile(const std::string& text, const std::string& name) {
  ProfileTable out;
  size_t at = 0;
  const std::vector<std::string> header = read_line(text, at);
  if (header.size() <= kColumns.size() || !std::equal(kColumns.begin(), kColumns.end(), header.begin()))
    throw UserError({name, 1, 0}, "this is not a profile of this version",
                    "`glint run ... --profile` writes one");
  out.reasons.assign(header.begin() + ptrdiff_t(kColumns.size()), header.end());
  for (int line = 2; at < text.size(); ++line) {
    const std::vector<std::string> cells = read_line(text, at);
    if (cells.size() != header.size())
      throw UserError({name, line, 0},
                      fmt::format("expected {} columns, found {}", header.size(), cells.size()));
    if (cells[0] != kLine) out.rows.push_back(row_of(cells, Numbers(cells, name, line)));
  }
  return out;
}

}  // namespace glint::report
