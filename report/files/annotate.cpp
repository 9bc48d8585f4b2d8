// Lays out annotated source.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/annotate.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <utility>

#include "report/files/profile_files.h"

namespace glint::report {
namespace {

using Row = std::vector<std::string>;
using Rows = std::vector<Row>;

Row joined(Row figures, const Row& more) {
  figures.insert(figures.end(), more.begin(), more.end());
  return figures;
}

// Adds up the rows of a program by what `key` returns.
template <class Key>
std::map<uint32_t, ProfileRow> summed(const ProfileTable& profile, uint32_t program, const Key& key) {
  std::map<uint32_t, ProfileRow> out;
  for (const ProfileRow& row : profile.rows)
    if (row.program == program && !row.shader.empty()) out[key(row)].add(row, row.slots);
  return out;
}

const ProfileRow* found(const std::map<uint32_t, ProfileRow>& rows, uint32_t key) {
  const auto at = rows.find(key);
  return at == rows.end() ? nullptr : &at->second;
}

}  // namespace

std::vector<FileShare> files_of(const ProfileTable& profile) {
  uint64_t whole = 0;
  std::map<std::string, uint64_t> cycles;
  for (const ProfileRow& row : profile.rows) {
    if (!row.shader.empty()) whole += row.total();
    if (row.line) cycles[row.file] += row.total();
  }
  std::vector<FileShare> out;
  for (const auto& [file, n] : cycles) out.push_back({file, part(n, whole)});
  std::stable_sort(out.begin(), out.end(),
                   [](const FileShare& a, const FileShare& b) { return a.share > b.share; });
  return out;
}

std::vector<uint32_t> programs_of(const ProfileTable& profile) {
  std::map<uint32_t, uint64_t> cycles;
  for (const ProfileRow& row : profile.rows)
    if (!row.shader.empty()) cycles[row.program] += row.total();
  std::vector<uint32_t> out;
  for (const auto& [program, n] : cycles) out.push_back(program);
  std::stable_sort(out.begin(), out.end(), [&](uint32_t a, uint32_t b) { return cycles[a] > cycles[b]; });
  return out;
}

Annotator::Annotator(const ProfileTable& profile, const SourceMap& map,
                     const std::vector<std::string>& measures, const Terminal& terminal)
    : profile_(profile), map_(map), terminal_(terminal), measures_(profile, measures, terminal) {
}

std::string Annotator::sheet(const std::string& heading, Row columns, const Rows& rows,
                             const std::string& alignment) const {
  Rows all{joined(measures_.headings(), columns)};
  all.insert(all.end(), rows.begin(), rows.end());
  return (terminal_.colour ? fmt::format("\x1b[1m{}\x1b[0m", heading) : heading) + "\n" +
         table(all, measures_.alignment() + alignment) + "\n";
}

// Returns a place such as "shade.glsl:12".
std::string Annotator::place(const ListedLine& line) const {
  if (line.line == 0 || line.file >= map_.files.size()) return "";
  return fmt::format("{}:{}", std::filesystem::path(map_.files[line.file].path).filename().string(),
                     line.line);
}

std::string Annotator::heading_of(uint32_t program, const std::string& what) const {
  uint64_t cycles = 0;
  for (const ProfileRow& row : profile_.rows)
    if (row.program == program && !row.shader.empty()) cycles += row.total();
  const ProgramListing& listing = map_.programs.at(program);
  return fmt::format("{} ({}), {}: {} of the cycles of all instructions", listing.shader, listing.stage, what,
                     measures_.share(cycles));
}

std::string Annotator::file(const SourceFile& file) const {
  std::map<uint32_t, ProfileRow> costs;
  uint64_t cycles = 0;
  for (ProfileRow& row : by_line(profile_))
    if (row.file == file.path) cycles += row.total(), costs[row.line] = std::move(row);
  const size_t last = std::max<size_t>(file.lines.size(), costs.empty() ? 0 : costs.rbegin()->first);
  Rows rows;
  for (uint32_t n = 1; n <= last; ++n) {
    const ProfileRow* const cost = found(costs, n);
    if (cost || file.is_known)
      rows.push_back(joined(measures_.cells(cost),
                            {std::to_string(n), n <= file.lines.size() ? file.lines[n - 1] : ""}));
  }
  return sheet(fmt::format("{}: {} of the cycles of all instructions", file.path, measures_.share(cycles)),
               {"line", "source"}, rows, "><");
}

std::string Annotator::spirv(uint32_t number) const {
  const ProgramListing& program = map_.programs.at(number);
  const std::map<uint32_t, ProfileRow> costs =
      summed(profile_, number, [](const ProfileRow& row) { return row.spirv; });
  if (program.spirv.empty()) return heading_of(number, "not compiled from SPIR-V") + "\n\n";
  Rows rows;
  bool in_function = false;  // What comes before it is declared, not run.
  for (uint32_t n = 1; n <= program.spirv.size(); ++n) {
    const ListedLine& line = program.spirv[n - 1];
    in_function |= line.text.find("= OpFunction ") != std::string::npos;
    if (const ProfileRow* const cost = found(costs, n); in_function || cost)
      rows.push_back(joined(measures_.cells(cost), {std::to_string(n), line.text, place(line)}));
  }
  if (const ProfileRow* const rest = found(costs, 0))
    rows.push_back(joined(measures_.cells(rest), {"", "(of no SPIR-V instruction)"}));
  return sheet(heading_of(number, "SPIR-V after optimisation"), {"number", "SPIR-V", "source"}, rows, "><<");
}

std::string Annotator::isa(uint32_t number) const {
  const ProgramListing& program = map_.programs.at(number);
  const std::map<uint32_t, ProfileRow> costs =
      summed(profile_, number, [](const ProfileRow& row) { return row.index; });
  Rows rows;
  for (uint32_t i = 0; i < program.isa.size(); ++i) {
    const ListedLine& line = program.isa[i];
    rows.push_back(
        joined(measures_.cells(found(costs, i)),
               {std::to_string(i), line.text, line.spirv ? std::to_string(line.spirv) : "", place(line)}));
  }
  return sheet(heading_of(number, "ISA"), {"index", "ISA", "SPIR-V", "source"}, rows, "><><");
}

// Adds the SPIR-V of `instructions`, in order, and below each instruction what it became.
void Annotator::add_below(Rows& rows, uint32_t program, const std::vector<uint32_t>& instructions) const {
  const ProgramListing& listing = map_.programs[program];
  const std::map<uint32_t, ProfileRow> by_spirv =
      summed(profile_, program, [](const ProfileRow& row) { return row.spirv; });
  const std::map<uint32_t, ProfileRow> by_index =
      summed(profile_, program, [](const ProfileRow& row) { return row.index; });
  std::map<uint32_t, std::vector<uint32_t>> parts;
  for (const uint32_t i : instructions) parts[listing.isa[i].spirv].push_back(i);
  for (const auto& [spirv, made] : parts) {
    if (spirv)
      rows.push_back(joined(measures_.cells(found(by_spirv, spirv)),
                            {std::to_string(spirv), "    " + listing.spirv[spirv - 1].text}));
    else if (!listing.spirv.empty())
      rows.push_back(joined(measures_.cells(nullptr), {"", "    (of no SPIR-V instruction)"}));
    for (const uint32_t i : made)
      rows.push_back(
          joined(measures_.cells(found(by_index, i)), {std::to_string(i), "        " + listing.isa[i].text}));
  }
}

Annotator::Parts Annotator::parts_of(size_t file) const {
  Parts out;
  for (uint32_t p = 0; p < map_.programs.size(); ++p)
    for (uint32_t i = 0; i < map_.programs[p].isa.size(); ++i)
      if (const ListedLine& line = map_.programs[p].isa[i]; line.line && line.file == file)
        out[line.line][p].push_back(i);
  return out;
}

// Adds the parts of a line, with a heading for each program where several have some.
void Annotator::add_programs(Rows& rows, const std::map<uint32_t, std::vector<uint32_t>>& programs) const {
  for (const auto& [program, instructions] : programs) {
    if (programs.size() > 1)
      rows.push_back(
          joined(measures_.cells(nullptr), {"", fmt::format("  {}:", map_.programs[program].stage)}));
    add_below(rows, program, instructions);
  }
}

std::string Annotator::all(size_t number) const {
  const SourceFile& file = map_.files.at(number);
  std::map<uint32_t, ProfileRow> costs;
  uint64_t cycles = 0;
  for (ProfileRow& row : by_line(profile_))
    if (row.file == file.path) cycles += row.total(), costs[row.line] = std::move(row);
  Rows rows;
  for (const auto& [n, programs] : parts_of(number)) {
    rows.push_back(
        joined(measures_.cells(found(costs, n)),
               {std::to_string(n), n <= file.lines.size() ? file.lines[n - 1] : "(text not known)"}));
    add_programs(rows, programs);
  }
  return sheet(fmt::format("{}: {} of the cycles of all instructions", file.path, measures_.share(cycles)),
               {"number", "source, below it SPIR-V, below it ISA"}, rows, "><");
}

std::string reason_table(const ProfileTable& profile, const Terminal& terminal) {
  std::vector<std::pair<uint64_t, std::string>> sums;
  uint64_t whole = 0;
  for (size_t i = 0; i < profile.reasons.size(); ++i) {
    uint64_t sum = 0;
    for (const ProfileRow& row : profile.rows) sum += row.slots[i];
    whole += sum;
    if (sum) sums.emplace_back(sum, profile.reasons[i]);
  }
  std::stable_sort(sums.begin(), sums.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  Rows rows;
  for (const auto& [sum, reason] : sums)
    rows.push_back(
        {reason, with_thousands(sum), percent(part(sum, whole)), bar(part(sum, whole), 20, terminal)});
  return fmt::format("cycles of all schedulers: {}\n", with_thousands(whole)) + table(rows, "<>><", " ") +
         "\n";
}

}  // namespace glint::report
