// Merges layers of TOML and reads typed keys out of them.
// SPDX-License-Identifier: Apache-2.0
#include "base/config.h"

#include <fmt/format.h>
#include <optional>
#include <set>
#include <utility>

#include "base/toml_text.h"

namespace glint {

struct ConfigTable::State {
  std::string path;   // dotted; "" for the root
  toml::table table;  // a copy, from which every key that is read is taken away
  std::set<std::string> known;
  SourceLocation place;
  Diagnostics* diagnostics = nullptr;
};

struct Config::Layers {
  toml::table merged;
};

namespace {

// Returns the place of the key and not of the value, because a copy of a value forgets its place.
SourceLocation location(const toml::key& key) {
  const toml::source_region& region = key.source();
  return {region.path ? *region.path : std::string(), int(region.begin.line), int(region.begin.column)};
}

std::string dotted(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : path + "." + std::string(key);
}

const char* type_name(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (node.is_array()) return "an array";
  if (node.is_string()) return "a string";
  if (node.is_integer()) return "an integer";
  if (node.is_floating_point()) return "a number";
  if (node.is_boolean()) return "a boolean";
  return "a date";
}

// Says whether a value that cannot be parsed was meant as a number, such as one of 20 digits.
bool is_number_like(const std::string& value) {
  return !value.empty() && value.find_first_not_of("+-_.0123456789") == std::string::npos;
}

SourceLocation location(const toml::table& table, std::string_view key) {
  const auto it = table.find(key);
  return it == table.end() ? SourceLocation{} : location(it->first);
}

// Copies node by node, so that each key keeps the file and line it came from.
void merge(toml::table& into, const toml::table& from) {
  for (const auto& [from_key, node] : from) {
    const toml::key& key = from_key;  // clang 14 captures no structured bindings
    toml::table* old = into.contains(key) ? into[key].as_table() : nullptr;
    if (old && node.is_table())
      merge(*old, *node.as_table());
    else
      node.visit([&](const auto& value) {
        into.erase(key);  // an assignment would keep the old key, and with it the old place
        into.insert(key, value);
      });
  }
}

}  // namespace

Config::Config() : layers_(std::make_unique<Layers>()) {
}
Config::~Config() = default;
Config::Config(Config&&) noexcept = default;

void Config::add_file(const std::string& path) {
  merge(layers_->merged, toml_of_file(path));
}

void Config::add_text(const std::string& name, const std::string& text) {
  merge(layers_->merged, toml_of_text(text, name));
}

void Config::add_setting(const std::string& key_value) {
  const std::string name = "--set " + key_value;
  const size_t equals = key_value.find('=');
  if (equals == std::string::npos || equals == 0)
    throw UserError({name}, "expected key=value", "for example --set core.warps=16");
  const std::string key = key_value.substr(0, equals), value = key_value.substr(equals + 1);
  const toml::table table = [&] {
    try {
      return toml::parse(key + " = " + value, name);
    } catch (const toml::parse_error& error) {
      if (is_number_like(value)) throw UserError({name}, std::string(error.description()));
      return toml_of_text(key + " = \"" + value + "\"", name);  // a bare word is a string
    }
  }();
  merge(layers_->merged, table);
}

ConfigTable Config::root(Diagnostics& diagnostics) const {
  auto state = std::make_shared<ConfigTable::State>();
  state->table = layers_->merged;
  state->diagnostics = &diagnostics;
  return ConfigTable(std::move(state));
}

bool ConfigTable::has(std::string_view key) const {
  return state_->table.contains(key);
}

SourceLocation ConfigTable::where(std::string_view key) const {
  return has(key) ? location(state_->table, key) : state_->place;
}

bool ConfigTable::take_bool(std::string_view key, bool fallback) {
  state_->known.emplace(key);
  const toml::node* node = state_->table.get(key);
  if (!node) return fallback;
  if (const auto value = node->value_exact<bool>()) return *value;
  state_->diagnostics->error(
      location(state_->table, key),
      fmt::format("'{}' is {}, expected true or false", dotted(state_->path, key), type_name(*node)));
  return fallback;
}

int64_t ConfigTable::take_integer(std::string_view key, int64_t fallback, int64_t min, int64_t max,
                                  std::string_view unit) {
  state_->known.emplace(key);
  const toml::node* node = state_->table.get(key);
  if (!node) return fallback;
  const std::string name = dotted(state_->path, key);
  const auto value = node->value_exact<int64_t>();
  if (!value) {
    state_->diagnostics->error(location(state_->table, key),
                               fmt::format("'{}' is {}, expected an integer{}{}", name, type_name(*node),
                                           unit.empty() ? "" : " in ", unit));
    return fallback;
  }
  if (*value < min || *value > max) {
    state_->diagnostics->error(location(state_->table, key),
                               fmt::format("'{}' is {}, expected {} to {} {}", name, *value, min, max, unit));
    return fallback;
  }
  return *value;
}

double ConfigTable::take_number(std::string_view key, double fallback, double min, double max,
                                std::string_view unit) {
  state_->known.emplace(key);
  const toml::node* node = state_->table.get(key);
  if (!node) return fallback;
  const std::string name = dotted(state_->path, key);
  const auto value = node->is_integer() ? std::optional<double>(double(*node->value_exact<int64_t>()))
                                        : node->value_exact<double>();
  if (!value) {
    state_->diagnostics->error(location(state_->table, key),
                               fmt::format("'{}' is {}, expected a number{}{}", name, type_name(*node),
                                           unit.empty() ? "" : " in ", unit));
    return fallback;
  }
  if (!(*value >= min && *value <= max)) {
    state_->diagnostics->error(location(state_->table, key),
                               fmt::format("'{}' is {}, expected {} to {} {}", name, *value, min, max, unit));
    return fallback;
  }
  return *value;
}

std::string ConfigTable::take_string(std::string_view key, const std::string& fallback) {
  state_->known.emplace(key);
  const toml::node* node = state_->table.get(key);
  if (!node) return fallback;
  if (const auto value = node->value_exact<std::string>()) return *value;
  state_->diagnostics->error(
      location(state_->table, key),
      fmt::format("'{}' is {}, expected a string", dotted(state_->path, key), type_name(*node)));
  return fallback;
}

std::string ConfigTable::take_name(std::string_view key, const std::string& fallback,
                                   const std::vector<std::string>& names) {
  const std::string value = take_string(key, fallback);
  for (const std::string& name : names)
    if (name == value) return value;
  const std::string guess = nearest(value, names);
  state_->diagnostics->error(where(key),
                             fmt::format("'{}' is \"{}\", expected one of: {}", dotted(state_->path, key),
                                         value, fmt::join(names, ", ")),
                             guess.empty() ? "" : fmt::format("did you mean \"{}\"?", guess));
  return fallback;
}

ConfigTable ConfigTable::take_table(std::string_view key) {
  state_->known.emplace(key);
  auto sub = std::make_shared<State>();
  sub->path = dotted(state_->path, key);
  sub->diagnostics = state_->diagnostics;
  sub->place = state_->place;
  if (const toml::node* node = state_->table.get(key)) {
    sub->place = location(state_->table, key);
    if (const toml::table* table = node->as_table())
      sub->table = *table;
    else
      state_->diagnostics->error(sub->place,
                                 fmt::format("'{}' is {}, expected a table", sub->path, type_name(*node)),
                                 fmt::format("write [{}] and its keys below", sub->path));
  }
  return ConfigTable(std::move(sub));
}

void ConfigTable::reject_the_rest() {
  const std::vector<std::string> known(state_->known.begin(), state_->known.end());
  for (const auto& [key, node] : state_->table) {
    const std::string name(key.str());
    if (state_->known.contains(name)) continue;
    const std::string guess = nearest(name, known);
    state_->diagnostics->error(location(key), fmt::format("unknown key '{}'", dotted(state_->path, name)),
                               known.empty()   ? "this table has no keys"
                               : guess.empty() ? fmt::format("known here: {}", fmt::join(known, ", "))
                                               : fmt::format("did you mean '{}'?", guess));
  }
}

std::string config_text(bool value) {
  return value ? "true" : "false";
}
std::string config_text(int64_t value) {
  return fmt::format("{}", value);
}
std::string config_text(const std::string& value) {
  return fmt::format("\"{}\"", value);
}
std::string config_text(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

}  // namespace glint
