// The keys of a resolved configuration as rows of text, for tables and for telling two configurations apart.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace glint::report {

struct ConfigRow {
  std::string key, value;  // "rt.warps", "4": as the file spells it, strings without their quotes
  std::string unit, doc;   // of the comment behind; "" without one
};

// Reads what config_file() writes: tables of dotted names, one key a line, its comment behind. Keeps the
// order.
std::vector<ConfigRow> config_rows(const std::string& toml);

// Keys of `run` whose value is another in `preset`, or that it does not have; each with the preset's value
// ("" = none).
struct ConfigChange {
  ConfigRow row;
  std::string preset;
};
std::vector<ConfigChange> config_changes(const std::vector<ConfigRow>& run,
                                         const std::vector<ConfigRow>& preset);

}  // namespace glint::report
