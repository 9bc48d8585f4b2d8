// Reads a finished run from its directory: statistics, facts of run.json and configuration keys, by name.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace glint::report {

// Throws UserError when run.json of a directory is absent, of another schema, or of a run that failed. In the
// last case the error has that run's message. A run that was ended early has results, and is accepted.
void check_finished(const std::string& directory);

// Throws UserError when a run has totals alone (`--stats compact`). `reader` says who needs more: "a report".
void check_full_statistics(const std::string& directory, const std::string& reader);

class RunRecord {
 public:
  // Reads a run. Throws UserError when a file is absent or is not what a run writes.
  static RunRecord read(const std::string& directory);

  // These read texts, for read() and tests: stats.csv, run.json, config.toml. Names are used in messages.
  void add_stats(const std::string& csv, const std::string& name);
  void add_facts(const std::string& json, const std::string& name);
  void add_config(const std::string& toml);
  void add_finished(const std::string& directory);  // run.json of a directory; throws as check_finished()

  // Returns the values of all statistics whose path matches (path_matches()), or none when none does.
  std::vector<double> values(const std::string& pattern) const;
  // Returns the parts of all breakdowns whose path matches, each summed over them, in order of appearance.
  std::vector<std::pair<std::string, double>> parts(const std::string& pattern) const;
  // Return a number of run.json by its dotted path ("scene.triangles"), or of the configuration ("rt.warps").
  std::optional<double> fact(const std::string& name) const { return find(facts_, name); }
  std::optional<double> config(const std::string& key) const { return find(config_, key); }
  // Returns a string of run.json, or "" when it has none.
  std::string text(const std::string& name) const;
  // Returns the strings of a table of run.json, sorted by their keys: those of "overrides".
  std::vector<std::pair<std::string, std::string>> texts_in(const std::string& table) const;

 private:
  static std::optional<double> find(const std::map<std::string, double>& map, const std::string& name);

  std::vector<std::pair<std::string, double>> stats_;
  std::map<std::string, double> facts_, config_;
  std::map<std::string, std::string> texts_;
};

}  // namespace glint::report
