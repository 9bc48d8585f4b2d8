// Adds up a profile for the report.
// SPDX-License-Identifier: Apache-2.0
#include "report/page/profile.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "report/files/profile_files.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMaxLines = 16;  // lines that the report shows; its source view shows the rest

Json counts_of(const ProfileRow& row) {
  return {{"issues", row.issues},   {"lanes", row.lanes}, {"accesses", row.accesses},
          {"sectors", row.sectors}, {"ended", row.ended}, {"latency", row.latency},
          {"cycles", row.total()},  {"slots", row.slots}};
}

// Returns the sums of the rows that share a name, the costliest first.
Json summed(const ProfileTable& profile, const std::string ProfileRow::*name) {
  std::map<std::string, ProfileRow> sums;
  for (const ProfileRow& row : profile.rows)
    if (!row.stage.empty()) sums[row.*name].add(row, row.slots);
  std::vector<std::pair<std::string, ProfileRow>> sorted(sums.begin(), sums.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second.total() > b.second.total(); });
  Json out = Json::array();
  for (const auto& [key, row] : sorted) {
    Json entry = {{"name", key}};
    entry.update(counts_of(row));
    out.push_back(std::move(entry));
  }
  return out;
}

// Returns the lines of a file, which is read once, or none when it cannot be read.
const std::vector<std::string>& lines_of(const std::string& path,
                                         std::map<std::string, std::vector<std::string>>& read) {
  const auto [found, is_new] = read.try_emplace(path);
  if (is_new) {
    std::ifstream in(path);
    for (std::string line; std::getline(in, line);) found->second.push_back(line);
  }
  return found->second;
}

Json costly_lines(const ProfileTable& profile) {
  std::vector<ProfileRow> rows = by_line(profile);
  std::stable_sort(rows.begin(), rows.end(),
                   [](const ProfileRow& a, const ProfileRow& b) { return a.total() > b.total(); });
  if (rows.size() > kMaxLines) rows.resize(kMaxLines);
  std::map<std::string, std::vector<std::string>> read;
  Json out = Json::array();
  for (const ProfileRow& row : rows) {
    const std::vector<std::string>& source = lines_of(row.file, read);
    Json entry = {{"file", row.file},
                  {"line", row.line},
                  {"text", row.line >= 1 && row.line <= source.size() ? source[row.line - 1] : ""}};
    entry.update(counts_of(row));
    out.push_back(std::move(entry));
  }
  return out;
}

}  // namespace

nlohmann::ordered_json page_profile(const ProfileTable& profile) {
  return {{"reasons", profile.reasons},
          {"ops", summed(profile, &ProfileRow::op)},
          {"stages", summed(profile, &ProfileRow::stage)},
          {"lines", costly_lines(profile)}};
}

}  // namespace glint::report
