// Writes figures of a profile's rows as cells.
// SPDX-License-Identifier: Apache-2.0
#include "report/metrics/measures.h"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <utility>

#include "base/diagnostics.h"

namespace glint::report {
namespace {

constexpr double kWarm = 0.01, kHot = 0.1;  // fractions of all cycles

std::string count(uint64_t value) {
  return value ? with_thousands(value) : "";
}

// Returns what the row's cycles without an issue were mostly spent on, such as "long_scoreboard 62.0 %".
std::string main_reason(const ProfileTable& profile, const ProfileRow& row) {
  if (row.slots.size() < 2) return "";
  const auto most = std::max_element(row.slots.begin() + 1, row.slots.end());
  if (*most == 0) return "";
  return fmt::format("{} {}", profile.reasons[size_t(most - row.slots.begin())],
                     percent(part(*most, row.total())));
}

}  // namespace

std::vector<std::string> measure_names(const ProfileTable& profile) {
  std::vector<std::string> out = {"cycles",   "issues",  "lanes",   "accesses",
                                  "requests", "sectors", "latency", "waits"};
  out.insert(out.end(), profile.reasons.begin(), profile.reasons.end());
  return out;
}

Measures::Measures(const ProfileTable& profile, std::vector<std::string> names, const Terminal& terminal)
    : profile_(profile), names_(std::move(names)), terminal_(terminal) {
  const std::vector<std::string> known = measure_names(profile);
  for (const std::string& name : names_)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw UserError({}, fmt::format("unknown measure '{}'", name),
                      fmt::format("the measures are {}", fmt::join(known, ", ")));
  for (const ProfileRow& row : profile.rows)
    if (!row.shader.empty()) whole_ += row.total();
}

std::vector<std::string> Measures::headings() const {
  std::vector<std::string> out;
  for (const std::string& name : names_) out.push_back(name == "waits" ? "mostly waits for" : name);
  return out;
}

std::string Measures::share(uint64_t cycles) const {
  return percent(part(cycles, whole_));
}

std::string Measures::cell(const std::string& name, const ProfileRow& row) const {
  if (name == "cycles") return share(row.total());
  if (name == "issues") return with_thousands(row.issues);
  if (name == "lanes") return row.issues ? fmt::format("{:.1f}", part(row.lanes, row.issues)) : "-";
  if (name == "accesses") return count(row.accesses);
  if (name == "requests") return count(row.requests);
  if (name == "sectors") return count(row.sectors);
  if (name == "latency") return row.ended ? fmt::format("{:.0f}", part(row.latency, row.ended)) : "";
  if (name == "waits") return main_reason(profile_, row);
  const auto reason = std::find(profile_.reasons.begin(), profile_.reasons.end(), name);
  const size_t i = size_t(reason - profile_.reasons.begin());
  return i < row.slots.size() ? count(row.slots[i]) : "";
}

std::vector<std::string> Measures::cells(const ProfileRow* row) const {
  std::vector<std::string> out(names_.size());
  if (!row) return out;
  const double heat = part(row->total(), whole_);
  const char* const colour = !terminal_.colour || heat < kWarm ? "" : heat < kHot ? "\x1b[33m" : "\x1b[1;31m";
  for (size_t i = 0; i < names_.size(); ++i) {
    out[i] = cell(names_[i], *row);
    if (*colour && !out[i].empty()) out[i] = colour + out[i] + "\x1b[0m";
  }
  return out;
}

std::string Measures::alignment() const {
  std::string out;
  for (const std::string& name : names_) out += name == "waits" ? '<' : '>';
  return out;
}

}  // namespace glint::report
