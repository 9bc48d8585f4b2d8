// Reads configurations: TOML presets, overlays and --set, with the source place of every key.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/diagnostics.h"

namespace glint {

// Holds one TOML table while it is read. Each take_*() marks its key as known, and reject_the_rest() reports
// all other keys with the nearest known name. Errors go to the Diagnostics given to Config; a value with an
// error stays at its default.
class ConfigTable {
 public:
  struct State;
  explicit ConfigTable(std::shared_ptr<State> state) : state_(std::move(state)) {}

  bool take_bool(std::string_view key, bool fallback);
  int64_t take_integer(std::string_view key, int64_t fallback, int64_t min, int64_t max,
                       std::string_view unit);
  double take_number(std::string_view key, double fallback, double min, double max, std::string_view unit);
  std::string take_name(std::string_view key, const std::string& fallback,
                        const std::vector<std::string>& names);
  std::string take_string(std::string_view key, const std::string& fallback);
  ConfigTable take_table(std::string_view key);  // an empty table when absent
  bool has(std::string_view key) const;
  // Returns the place of the key, or of the table when the key is absent.
  SourceLocation where(std::string_view key) const;
  void reject_the_rest();

 private:
  std::shared_ptr<State> state_;
};

// Holds a merged configuration. A later layer overrides an earlier one key by key.
class Config {
 public:
  Config();
  ~Config();
  Config(Config&&) noexcept;
  void add_file(const std::string& path);  // throws UserError when the file is absent or not TOML
  void add_text(const std::string& name, const std::string& toml);
  // Takes a setting such as "core.warps=16". The value has TOML's spelling, and a bare word is a string.
  void add_setting(const std::string& key_value);
  ConfigTable root(Diagnostics& diagnostics) const;

 private:
  struct Layers;
  std::unique_ptr<Layers> layers_;
};

// Returns the TOML spelling of a value.
std::string config_text(bool value);
std::string config_text(double value);
std::string config_text(const std::string& value);
std::string config_text(int64_t value);
inline std::string config_text(uint64_t value) {
  return config_text(int64_t(value));
}
inline std::string config_text(uint32_t value) {
  return config_text(int64_t(value));
}
inline std::string config_text(int32_t value) {
  return config_text(int64_t(value));
}
inline std::string config_text(uint16_t value) {
  return config_text(int64_t(value));
}
inline std::string config_text(uint8_t value) {
  return config_text(int64_t(value));
}
inline std::string config_text(float value) {
  return config_text(double(value));
}

}  // namespace glint
