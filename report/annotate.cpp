// Layout of annotated source.
// SPDX-License-Identifier: Apache-2.0
#include "report/annotate.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "report/profile_files.h"

namespace glint::report {
namespace {

using Rows = std::vector<std::vector<std::string>>;

// Of all instructions, known lines or not.
uint64_t instruction_cycles(const ProfileTable& profile) {
  uint64_t sum = 0;
  for (const ProfileRow& row : profile.rows)
    if (!row.shader.empty()) sum += row.total();
  return sum;
}

double part(uint64_t of, uint64_t whole) { return whole ? double(of) / double(whole) : 0.0; }

// "long_scoreboard 62.0 %": what most of the line's cycles that issued nothing were spent on.
std::string main_reason(const ProfileTable& profile, const ProfileRow& row) {
  if (row.slots.size() < 2) return "";
  const auto most = std::max_element(row.slots.begin() + 1, row.slots.end());
  if (*most == 0) return "";
  return fmt::format("{} {}", profile.reasons[size_t(most - row.slots.begin())], percent(part(*most, row.total())));
}

std::string without_tabs(const std::string& line) {
  std::string out;
  for (const char c : line) out += c == '\t' ? std::string(4, ' ') : c == '\r' ? std::string() : std::string(1, c);
  return out;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    out.push_back(without_tabs(text.substr(at, end - at)));
    at = end + 1;
  }
  return out;
}

}  // namespace

std::vector<FileShare> files_of(const ProfileTable& profile) {
  const uint64_t whole = instruction_cycles(profile);
  std::map<std::string, uint64_t> cycles;
  for (const ProfileRow& row : profile.rows)
    if (row.line) cycles[row.file] += row.total();
  std::vector<FileShare> out;
  for (const auto& [file, n] : cycles) out.push_back({file, part(n, whole)});
  std::stable_sort(out.begin(), out.end(), [](const FileShare& a, const FileShare& b) { return a.share > b.share; });
  return out;
}

std::string annotate(const ProfileTable& profile, const std::string& file, const std::optional<std::string>& source,
                     const Terminal& terminal) {
  const uint64_t whole = instruction_cycles(profile);
  std::map<uint32_t, ProfileRow> costs;
  uint64_t of_file = 0;
  for (ProfileRow& row : by_line(profile))
    if (row.file == file) of_file += row.total(), costs[row.line] = std::move(row);
  const std::vector<std::string> text = source ? lines_of(*source) : std::vector<std::string>();
  const size_t last = std::max<size_t>(text.size(), costs.empty() ? 0 : costs.rbegin()->first);

  Rows rows{{"cycles", "issues", "lanes", "sectors", "mostly waits for", "line", "source"}};
  for (uint32_t n = 1; n <= last; ++n) {
    const auto cost = costs.find(n);
    if (cost == costs.end() && !source) continue;
    std::vector<std::string> cells(5);
    if (cost != costs.end()) {
      const ProfileRow& row = cost->second;
      cells = {percent(part(row.total(), whole)), with_thousands(row.issues), row.issues ? fmt::format("{:.1f}", part(row.lanes, row.issues)) : "-",
               row.sectors ? with_thousands(row.sectors) : "", main_reason(profile, row)};
    }
    cells.push_back(std::to_string(n));
    cells.push_back(n <= text.size() ? text[n - 1] : "");
    rows.push_back(std::move(cells));
  }
  const std::string heading = fmt::format("{}: {} of the cycles of all instructions", file, percent(part(of_file, whole)));
  return (terminal.colour ? fmt::format("\x1b[1m{}\x1b[0m", heading) : heading) + "\n" + table(rows, ">>>><><") + "\n";
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
  for (const auto& [sum, reason] : sums) rows.push_back({reason, with_thousands(sum), percent(part(sum, whole)), bar(part(sum, whole), 20, terminal)});
  return fmt::format("cycles of all schedulers: {}\n", with_thousands(whole)) + table(rows, "<>><", " ") + "\n";
}

}  // namespace glint::report
