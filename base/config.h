// Reading configuration: TOML presets, overlays and --set, with the source place of every key.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"

namespace glint {

// One TOML table being read. Each take_* marks its key as known; reject_the_rest() reports all others with
// the nearest known name. Errors go to the Diagnostics given to Config; values stay at their defaults then.
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
  SourceLocation where(std::string_view key) const;  // of the key, or of the table when absent
  void reject_the_rest();

 private:
  std::shared_ptr<State> state_;
};

// A merged configuration: later layers win key by key.
class Config {
 public:
  Config();
  ~Config();
  Config(Config&&) noexcept;
  void add_file(const std::string& path);  // UserError when absent or not TOML
  void add_text(const std::string& name, const std::string& toml);
  void add_setting(
      const std::string& key_value);  // "core.warps=16"; the value in TOML's spelling, bare words are strings
  ConfigTable root(Diagnostics& diagnostics) const;

 private:
  struct Layers;
  std::unique_ptr<Layers> layers_;
};

// TOML spelling of a value.
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
