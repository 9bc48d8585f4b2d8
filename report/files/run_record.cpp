// Reads back what a run has written.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/run_record.h"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <utility>

#include "base/diagnostics.h"
#include "report/files/csv_field.h"
#include "report/files/file_list.h"
#include "report/files/run_directory.h"
#include "report/files/run_facts.h"
#include "report/files/stat_rows.h"

namespace glint::report {
namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
    text.remove_suffix(1);
  return text;
}

void flatten(const nlohmann::json& json, const std::string& name, std::map<std::string, double>& numbers,
             std::map<std::string, std::string>& texts) {
  if (json.is_object()) {
    for (const auto& [key, value] : json.items())
      flatten(value, name.empty() ? key : name + "." + key, numbers, texts);
  } else if (json.is_number()) {
    numbers[name] = json.get<double>();
  } else if (json.is_string()) {
    texts[name] = json.get<std::string>();
  }
}

}  // namespace

void RunRecord::add_finished(const std::string& directory) {
  const std::string file = directory + "/run.json";
  add_facts(read_run_facts(file).dump(), file);
  if (const double schema = fact("schema").value_or(0); schema != kRunSchema)
    throw UserError({file}, fmt::format("it has schema {}, expected {}", schema, kRunSchema),
                    "another version of Glint wrote it: run it again with this one");
  if (const double exit = fact("exit").value_or(0); exit != 0 && text("partial.reason").empty())
    throw UserError({file}, fmt::format("the run failed with exit code {}: {}", exit, text("message")),
                    "the run left no results: run it again");
}

void check_finished(const std::string& directory) {
  RunRecord().add_finished(directory);
}

void check_full_statistics(const std::string& directory, const std::string& reader) {
  RunRecord record;
  record.add_finished(directory);
  if (record.text("statistics") == "compact")
    throw UserError(
        {directory}, fmt::format("the run has compact statistics, and {} needs those of every unit", reader),
        "run it again without --stats compact; `compare` and `stats --format metrics` can read it");
}

RunRecord RunRecord::read(const std::string& directory) {
  RunRecord record;
  record.add_finished(directory);
  const ListedFiles files = ListedFiles::of_run(directory);
  record.add_stats(files.need("stats.csv"), directory + "/stats.csv");
  record.add_config(files.need("config.toml"));
  return record;
}

// Paths and values of stats.csv are never quoted, because neither holds a comma.
void RunRecord::add_stats(const std::string& csv, const std::string& name) {
  std::istringstream in(csv);
  std::string line;
  if (!std::getline(in, line) || line.rfind("path,value,", 0) != 0)
    throw UserError({name, 1}, "this is not a table of statistics",
                    "expected the header path,value,unit,doc");
  for (int row = 2; std::getline(in, line); ++row) {
    const size_t first = line.find(','), second = line.find(',', first + 1);
    const std::optional<double> value =
        second == std::string::npos
            ? std::nullopt
            : finite_number(std::string_view(line).substr(first + 1, second - first - 1));
    if (!value)
      throw UserError({name, row}, "this row has no finite value", "the file is damaged; run it again");
    stats_.emplace_back(line.substr(0, first), *value);
  }
}

void RunRecord::add_facts(const std::string& json, const std::string& name) {
  const nlohmann::json parsed = nlohmann::json::parse(json, nullptr, false);
  if (!parsed.is_object()) throw UserError({name}, "this is not a JSON object");
  flatten(parsed, "", facts_, texts_);
}

// Reads what config_file() writes: tables of dotted names, one key per line, comments behind. Only numbers
// are kept.
void RunRecord::add_config(const std::string& toml) {
  std::istringstream in(toml);
  std::string line, table;
  while (std::getline(in, line)) {
    const std::string_view text = trimmed(std::string_view(line).substr(0, line.find('#')));
    const size_t equals = text.find('=');
    if (text.size() > 2 && text.front() == '[' && text.back() == ']') {
      table = std::string(text.substr(1, text.size() - 2)) + ".";
    } else if (equals != std::string_view::npos) {
      if (const auto value = finite_number(trimmed(text.substr(equals + 1))))
        config_[table + std::string(trimmed(text.substr(0, equals)))] = *value;
    }
  }
}

std::vector<double> RunRecord::values(const std::string& pattern) const {
  std::vector<double> out;
  for (const auto& [path, value] : stats_)
    if (path_matches(pattern, path)) out.push_back(value);
  return out;
}

std::vector<std::pair<std::string, double>> RunRecord::parts(const std::string& pattern) const {
  std::vector<std::pair<std::string, double>> out;
  for (const auto& [path, value] : stats_) {
    const size_t colons = path.find("::");
    if (colons == std::string::npos || !path_matches(pattern, std::string_view(path).substr(0, colons)))
      continue;
    const std::string part = path.substr(colons + 2);
    const auto same =
        std::find_if(out.begin(), out.end(), [&](const auto& one) { return one.first == part; });
    if (same == out.end())
      out.emplace_back(part, value);
    else
      same->second += value;
  }
  return out;
}

std::string RunRecord::text(const std::string& name) const {
  const auto found = texts_.find(name);
  return found == texts_.end() ? "" : found->second;
}

std::vector<std::pair<std::string, std::string>> RunRecord::texts_in(const std::string& table) const {
  std::vector<std::pair<std::string, std::string>> out;
  const std::string prefix = table + ".";
  for (auto it = texts_.lower_bound(prefix); it != texts_.end() && it->first.starts_with(prefix); ++it)
    out.emplace_back(it->first.substr(prefix.size()), it->second);
  return out;
}

std::optional<double> RunRecord::find(const std::map<std::string, double>& map, const std::string& name) {
  const auto found = map.find(name);
  return found == map.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace glint::report
