// Matches the lines of two runs and lays out what changed.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/line_changes.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <set>
#include <tuple>

#include "base/diagnostics.h"
#include "report/files/profile_files.h"

namespace glint::report {
namespace {

using Costs = std::map<uint32_t, uint64_t>;  // by line

// Holds a file of one run.
struct CostedFile {
  const SourceFile* source = nullptr;  // null: the run's source.json does not list it
  Costs costs;
  uint64_t cost = 0;

  bool is_known() const { return source && source->is_known; }
  std::string text(uint32_t line) const {
    return is_known() && line <= source->lines.size() ? source->lines[line - 1] : "";
  }
};

std::map<std::string, CostedFile> costed_files(const ProfiledRun& run, const CostOf& cost) {
  std::map<std::string, CostedFile> out;
  for (const ProfileRow& line : by_line(run.profile)) {
    CostedFile& file = out[line.file];
    file.costs[line.line] = cost(line);
    file.cost += cost(line);
  }
  // A file is listed without having run, too: its lines may have been all taken by the other run.
  for (const SourceFile& file : run.map.files) out[file.path].source = &file;
  return out;
}

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

// Maps files of the first run to those of the second.
std::map<std::string, std::string> matched_files(const std::map<std::string, CostedFile>& before,
                                                 const std::map<std::string, CostedFile>& after) {
  std::map<std::string, std::string> out;
  std::map<std::string, std::vector<std::string>> was, is;  // files without an equal path, by name
  for (const auto& [path, file] : before)
    if (after.contains(path))
      out[path] = path;
    else
      was[file_name(path)].push_back(path);
  for (const auto& [path, file] : after)
    if (!before.contains(path)) is[file_name(path)].push_back(path);
  for (const auto& [name, paths] : was)
    if (const auto found = is.find(name); found != is.end() && paths.size() == 1 && found->second.size() == 1)
      out[paths[0]] = found->second[0];
  return out;
}

// Adds the lines of a file that both runs have.
void add_file(LineComparison& out, const std::string& path, const CostedFile& was, const CostedFile& is) {
  FileDifference difference{path, was.is_known() && is.is_known(), 0, 0};
  std::map<uint32_t, uint32_t> to_after, to_before;
  if (difference.is_known) {
    for (const auto& [one, other] : matched_lines(was.source->lines, is.source->lines))
      to_after[one] = other, to_before[other] = one;
    difference.only_before = was.source->lines.size() - to_after.size();
    difference.only_after = is.source->lines.size() - to_before.size();
  } else {
    for (const auto& [line, cost] : was.costs) to_after[line] = to_before[line] = line;
    for (const auto& [line, cost] : is.costs) to_after[line] = to_before[line] = line;
  }
  if (!difference.is_known || difference.only_before + difference.only_after > 0)
    out.differ.push_back(difference);
  const auto at = [](const auto& map, uint32_t line) {
    const auto found = map.find(line);
    return found == map.end() ? 0 : found->second;
  };
  std::vector<LineChange> lines;
  for (const auto& [line, cost] : was.costs) {
    const uint32_t other = at(to_after, line);
    lines.push_back({path, line, other, was.text(line), cost, other ? at(is.costs, other) : 0});
  }
  for (const auto& [line, cost] : is.costs)
    if (const uint32_t other = at(to_before, line); !other || !was.costs.contains(other))
      lines.push_back({path, other, line, is.text(line), 0, cost});
  // A line of the second run alone goes where its number is.
  std::stable_sort(lines.begin(), lines.end(), [](const LineChange& a, const LineChange& b) {
    const auto key = [](const LineChange& c) { return c.before && c.after ? c.after : c.before + c.after; };
    return key(a) < key(b);
  });
  out.lines.insert(out.lines.end(), lines.begin(), lines.end());
}

// Adds the lines of a file that one run alone has.
void add_single(LineComparison& out, const std::string& path, const CostedFile& file, bool is_before) {
  if (file.cost == 0) return;
  out.unmatched.push_back(path);
  for (const auto& [line, cost] : file.costs)
    out.lines.push_back({path, is_before ? line : 0, is_before ? 0 : line, file.text(line),
                         is_before ? cost : 0, is_before ? 0 : cost});
}

// Returns the cost of all instructions, and of those without a line.
std::pair<uint64_t, uint64_t> wholes(const ProfileTable& profile, const CostOf& cost) {
  uint64_t whole = 0, without = 0;
  for (const ProfileRow& row : profile.rows) {
    if (row.shader.empty()) continue;
    whole += cost(row);
    if (row.line == 0) without += cost(row);
  }
  return {whole, without};
}

uint64_t change_size(const LineChange& c) {
  return c.cost_after > c.cost_before ? c.cost_after - c.cost_before : c.cost_before - c.cost_after;
}

std::string signed_count(uint64_t before, uint64_t after) {
  if (before == after) return "=";
  return after > before ? "+" + with_thousands(after - before) : "-" + with_thousands(before - after);
}

std::vector<std::string> cost_cells(uint64_t before, uint64_t after) {
  return {with_thousands(before), with_thousands(after), signed_count(before, after),
          before ? fmt::format("{:.2f}", part(after, before)) : "-"};
}

std::vector<std::string> change_cells(const LineChange& c) {
  std::vector<std::string> cells = cost_cells(c.cost_before, c.cost_after);
  const auto number = [](uint32_t line) { return line ? std::to_string(line) : std::string("-"); };
  const std::string lines = c.before == c.after ? number(c.after) : number(c.before) + ">" + number(c.after);
  cells.push_back(file_name(c.file) + ":" + lines);
  cells.push_back(c.text);
  return cells;
}

}  // namespace

CostOf cost_of(const std::string& measure, const ProfileTable& profile) {
  if (measure == "cycles") return [](const ProfileRow& row) { return row.total(); };
  if (measure == "issues") return [](const ProfileRow& row) { return row.issues; };
  if (measure == "accesses") return [](const ProfileRow& row) { return row.accesses; };
  if (measure == "requests") return [](const ProfileRow& row) { return row.requests; };
  if (measure == "sectors") return [](const ProfileRow& row) { return row.sectors; };
  const auto reason = std::find(profile.reasons.begin(), profile.reasons.end(), measure);
  if (reason == profile.reasons.end())
    throw UserError({}, fmt::format("lines of two runs cannot be compared by '{}'", measure),
                    "compare them by cycles, issues, accesses, requests, sectors or a reason of "
                    "docs/profiling.md");
  const size_t i = size_t(reason - profile.reasons.begin());
  return [i](const ProfileRow& row) { return i < row.slots.size() ? row.slots[i] : 0; };
}

std::vector<std::pair<uint32_t, uint32_t>> matched_lines(const std::vector<std::string>& before,
                                                         const std::vector<std::string>& after) {
  constexpr size_t kMostPairs = size_t{16} << 20;
  std::vector<std::pair<uint32_t, uint32_t>> out;
  const size_t shorter = std::min(before.size(), after.size());
  size_t head = 0, tail = 0;
  while (head < shorter && before[head] == after[head]) ++head;
  while (tail < shorter - head && before[before.size() - 1 - tail] == after[after.size() - 1 - tail]) ++tail;
  for (size_t i = 0; i < head; ++i) out.emplace_back(i + 1, i + 1);
  const size_t rows = before.size() - head - tail, columns = after.size() - head - tail;
  if (rows && columns && rows <= kMostPairs / columns) {
    // common[i][j] is the length of the longest sequence that the rests from i and from j share.
    std::vector<uint32_t> common((rows + 1) * (columns + 1));
    const auto at = [&](size_t i, size_t j) -> uint32_t& { return common[i * (columns + 1) + j]; };
    const auto same = [&](size_t i, size_t j) { return before[head + i] == after[head + j]; };
    for (size_t i = rows; i-- > 0;)
      for (size_t j = columns; j-- > 0;)
        at(i, j) = same(i, j) ? at(i + 1, j + 1) + 1 : std::max(at(i + 1, j), at(i, j + 1));
    for (size_t i = 0, j = 0; i < rows && j < columns;) {
      if (same(i, j))
        out.emplace_back(head + ++i, head + ++j);
      else if (at(i + 1, j) >= at(i, j + 1))
        ++i;
      else
        ++j;
    }
  }
  for (size_t k = tail; k > 0; --k) out.emplace_back(before.size() - k + 1, after.size() - k + 1);
  return out;
}

LineComparison compare_lines(const ProfiledRun& before, const ProfiledRun& after,
                             const std::string& measure) {
  const CostOf cost_before = cost_of(measure, before.profile), cost_after = cost_of(measure, after.profile);
  const auto was = costed_files(before, cost_before), is = costed_files(after, cost_after);
  const std::map<std::string, std::string> pairs = matched_files(was, is);
  LineComparison out;
  out.files = pairs.size();
  // The costliest files of both runs together come first.
  std::vector<std::tuple<uint64_t, std::string, std::string>> order;
  for (const auto& [one, other] : pairs) order.emplace_back(was.at(one).cost + is.at(other).cost, one, other);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return std::get<0>(a) > std::get<0>(b); });
  std::set<std::string> taken;
  for (const auto& [sum, one, other] : order) {
    add_file(out, one, was.at(one), is.at(other));
    taken.insert(other);
  }
  for (const auto& [path, file] : was)
    if (!pairs.contains(path)) add_single(out, path, file, true);
  for (const auto& [path, file] : is)
    if (!taken.contains(path)) add_single(out, path, file, false);
  std::tie(out.whole_before, out.no_line_before) = wholes(before.profile, cost_before);
  std::tie(out.whole_after, out.no_line_after) = wholes(after.profile, cost_after);
  return out;
}

std::string line_changes_text(const LineComparison& comparison, const std::string& measure, size_t top) {
  std::vector<LineChange> lines = comparison.lines;
  std::erase_if(lines, [](const LineChange& c) { return c.cost_before + c.cost_after == 0; });
  const size_t of = lines.size();
  if (top) {
    std::erase_if(lines, [](const LineChange& c) { return change_size(c) == 0; });
    std::stable_sort(lines.begin(), lines.end(), [](const LineChange& a, const LineChange& b) {
      return change_size(a) > change_size(b);
    });
    if (lines.size() > top) lines.resize(top);
  }
  std::vector<std::vector<std::string>> rows{
      {measure + " in A", measure + " in B", "change", "B / A", "place", "source"}};
  const auto total = [&](uint64_t before, uint64_t after, const char* what) {
    rows.push_back(cost_cells(before, after));
    rows.back().insert(rows.back().end(), {"", what});
  };
  total(comparison.whole_before, comparison.whole_after, "(all instructions)");
  if (comparison.no_line_before + comparison.no_line_after)
    total(comparison.no_line_before, comparison.no_line_after, "(instructions without a line)");
  for (const LineChange& line : lines) rows.push_back(change_cells(line));
  std::string heading;
  if (top)
    heading = lines.empty() ? fmt::format("None of the {} lines changed\n", of)
                            : fmt::format("The {} of {} lines that changed most\n", lines.size(), of);
  return heading + table(rows, ">>>><<");
}

}  // namespace glint::report
