// Lays out the lines and instructions that cost most.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <initializer_list>
#include <map>
#include <utility>

#include "report/files/annotate.h"
#include "report/files/profile_files.h"

namespace glint::report {
namespace {

// Leaves the `count` rows with the most cycles, the costliest first. Rows of the same cost keep their order.
void keep_costliest(std::vector<ProfileRow>& rows, size_t count) {
  std::stable_sort(rows.begin(), rows.end(),
                   [](const ProfileRow& a, const ProfileRow& b) { return a.total() > b.total(); });
  if (rows.size() > count) rows.erase(rows.begin() + std::ptrdiff_t(count), rows.end());
}

std::vector<std::string> appended(std::vector<std::string> cells, std::initializer_list<std::string> more) {
  cells.insert(cells.end(), more.begin(), more.end());
  return cells;
}

}  // namespace

std::string Annotator::top_heading(const std::vector<ProfileRow>& top, size_t of,
                                   const std::string& what) const {
  uint64_t cycles = 0;
  for (const ProfileRow& row : top) cycles += row.total();
  return fmt::format("The {} of {} {} that cost most: {} of the cycles of all instructions", top.size(), of,
                     what, measures_.share(cycles));
}

std::string Annotator::top_lines(size_t count, const IsWanted& is_wanted, bool with_parts) const {
  std::vector<ProfileRow> lines = by_line(profile_);
  std::erase_if(lines, [&](const ProfileRow& line) { return !is_wanted(line.file); });
  const size_t of = lines.size();
  keep_costliest(lines, count);
  std::vector<std::vector<std::string>> rows;
  for (const ProfileRow& line : lines) {
    const auto file = std::find_if(map_.files.begin(), map_.files.end(),
                                   [&](const SourceFile& one) { return one.path == line.file; });
    const bool is_known = file != map_.files.end() && line.line <= file->lines.size();
    const uint16_t number = uint16_t(file - map_.files.begin());
    rows.push_back(appended(
        measures_.cells(&line),
        {place({"", number, line.line, 0, 0}), is_known ? file->lines[line.line - 1] : "(text not known)"}));
    if (with_parts) add_programs(rows, parts_of(number)[line.line]);
  }
  return sheet(top_heading(lines, of, "lines"),
               {"place", with_parts ? "source, below it SPIR-V, below it ISA" : "source"}, rows, "><");
}

std::string Annotator::top_instructions(size_t count, const IsWantedProgram& is_wanted, bool in_spirv) const {
  std::map<std::pair<uint32_t, uint32_t>, ProfileRow> sums;
  for (const ProfileRow& row : profile_.rows) {
    if (row.shader.empty() || !is_wanted(row.program)) continue;
    ProfileRow& sum = sums[{row.program, in_spirv ? row.spirv : row.index}];
    sum.program = row.program, sum.index = row.index, sum.spirv = row.spirv;
    sum.add(row, row.slots);
  }
  std::vector<ProfileRow> top;
  for (auto& [key, row] : sums) top.push_back(std::move(row));
  const size_t of = top.size();
  keep_costliest(top, count);
  std::vector<std::vector<std::string>> rows;
  for (const ProfileRow& row : top) {
    const ProgramListing& program = map_.programs.at(row.program);
    const ListedLine none{"(of no SPIR-V instruction)", 0, 0, 0, 0};
    const ListedLine& line = !in_spirv        ? program.isa.at(row.index)
                             : row.spirv == 0 ? none
                                              : program.spirv.at(row.spirv - 1);
    rows.push_back(appended(measures_.cells(&row),
                            {std::filesystem::path(program.shader).filename().string(),
                             std::to_string(in_spirv ? row.spirv : row.index), line.text, place(line)}));
  }
  return sheet(top_heading(top, of, in_spirv ? "SPIR-V instructions" : "instructions"),
               {"shader", in_spirv ? "number" : "index", in_spirv ? "SPIR-V" : "ISA", "source"}, rows,
               "<><<");
}

}  // namespace glint::report
