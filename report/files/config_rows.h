// Reads the keys of a resolved configuration as rows of text, for tables and for telling configurations
// apart.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace glint::report {

struct ConfigRow {
  std::string key, value;  // "rt.warps", "4", as the file spells them; strings are without quotes
  std::string unit, doc;   // from the comment behind; "" without one
};

// Reads what config_file() writes: tables of dotted names, one key per line with its comment behind. The
// order is kept.
std::vector<ConfigRow> config_rows(const std::string& toml);

// Holds a key of `run` whose value differs in `preset` or that `preset` does not have, with the preset's
// value ("" when there is none).
struct ConfigChange {
  ConfigRow row;
  std::string preset;
};
std::vector<ConfigChange> config_changes(const std::vector<ConfigRow>& run,
                                         const std::vector<ConfigRow>& preset);

}  // namespace glint::report
