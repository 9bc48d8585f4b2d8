// Makes values from toml++'s tables, and reads typed keys.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/description/value.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>
#include <utility>

#include "base/toml_text.h"

namespace glint::pipeline {
namespace {

SourceLocation place(const std::string& file, const toml::source_region& region) {
  return {file, int(region.begin.line), int(region.begin.column)};
}

Value value_of(const toml::node& node, const std::string& file) {
  Value out;
  out.where = place(file, node.source());
  if (const auto* table = node.as_table()) {
    out.kind = Value::Kind::Table;
    for (const auto& [key, child] : *table) {
      Value value = value_of(child, file);
      value.where = place(file, key.source());
      out.table.push_back({std::string(key.str()), std::move(value)});
    }
    std::stable_sort(out.table.begin(), out.table.end(), [](const auto& a, const auto& b) {
      return std::pair(a.value.where.line, a.value.where.column) <
             std::pair(b.value.where.line, b.value.where.column);
    });
  } else if (const auto* list = node.as_array()) {
    out.kind = Value::Kind::List;
    for (const toml::node& child : *list) out.list.push_back(value_of(child, file));
  } else if (node.is_string()) {
    out.kind = Value::Kind::Text, out.text = *node.value<std::string>();
  } else if (node.is_integer()) {
    out.kind = Value::Kind::Integer, out.whole = *node.value<int64_t>(), out.real = double(out.whole);
  } else if (node.is_floating_point()) {
    out.kind = Value::Kind::Real, out.real = *node.value<double>();
  } else if (node.is_boolean()) {
    out.kind = Value::Kind::Bool, out.flag = *node.value<bool>();
  }
  return out;
}

const char* name_of(Value::Kind kind) {
  constexpr const char* kNames[] = {"a date or a time", "true or false", "a whole number", "a number",
                                    "a string",         "a list",        "a table"};
  static_assert(std::size(kNames) == size_t(Value::Kind::Table) + 1);
  return kNames[size_t(kind)];
}

void flatten(const Value& value, std::vector<double>& out, bool& good) {
  if (value.kind == Value::Kind::List)
    for (const Value& each : value.list) flatten(each, out, good);
  else if (value.is_number())
    out.push_back(value.real);
  else
    good = false;
}

}  // namespace

const Value* Value::find(const std::string& key) const {
  for (const auto& [name, value] : table)
    if (name == key) return &value;
  return nullptr;
}

Value read_toml(const std::string& path) {
  return value_of(toml_of_file(path), path);
}
Value parse_toml(const std::string& text, const std::string& name) {
  return value_of(toml_of_text(text, name), name);
}

TableReader::TableReader(const Value& table, std::string what, Diagnostics& errors)
    : table_(table), what_(std::move(what)), errors_(errors) {
  if (table.kind != Value::Kind::Table)
    errors_.error(table.where, fmt::format("{} must be a table, not {}", what_, name_of(table.kind)));
}

void TableReader::wrong(const Value& value, const std::string& key, const std::string& expected) {
  errors_.error(value.where, fmt::format("'{}' is {}, expected {}", key, name_of(value.kind), expected));
}

const Value* TableReader::take(const std::string& key) {
  known_.insert(key);
  return table_.find(key);
}

std::string TableReader::text(const std::string& key, const std::string& fallback) {
  const Value* value = take(key);
  if (value && value->kind != Value::Kind::Text) wrong(*value, key, "a string");
  return value && value->kind == Value::Kind::Text ? value->text : fallback;
}

std::string TableReader::required_text(const std::string& key) {
  if (!take(key)) errors_.error(table_.where, fmt::format("{} needs '{}'", what_, key));
  return text(key);
}

std::string TableReader::name(const std::string& key, const std::string& fallback,
                              const std::vector<std::string>& names) {
  const std::string found = text(key, fallback);
  if (std::find(names.begin(), names.end(), found) != names.end()) return found;
  const std::string near = nearest(found, names);
  const Value* value = take(key);
  errors_.error(value ? value->where : table_.where,
                fmt::format("'{}' is '{}', expected one of {}", key, found, fmt::join(names, ", ")),
                near.empty() ? "" : fmt::format("did you mean '{}'?", near));
  return fallback;
}

std::optional<int64_t> TableReader::optional_integer(const std::string& key, int64_t least, int64_t most) {
  const Value* value = take(key);
  if (!value) return {};
  if (value->kind == Value::Kind::Integer && value->whole >= least && value->whole <= most)
    return value->whole;
  if (value->kind == Value::Kind::Integer)
    errors_.error(value->where, fmt::format("'{}' is {}, expected {} to {}", key, value->whole, least, most));
  else
    wrong(*value, key, fmt::format("a whole number from {} to {}", least, most));
  return {};
}

int64_t TableReader::integer(const std::string& key, int64_t fallback, int64_t least, int64_t most) {
  return optional_integer(key, least, most).value_or(fallback);
}

double TableReader::number(const std::string& key, double fallback) {
  const Value* value = take(key);
  if (value && !value->is_number()) wrong(*value, key, "a number");
  return value && value->is_number() ? value->real : fallback;
}

bool TableReader::flag(const std::string& key, bool fallback) {
  const Value* value = take(key);
  if (value && value->kind != Value::Kind::Bool) wrong(*value, key, "true or false");
  return value && value->kind == Value::Kind::Bool ? value->flag : fallback;
}

std::vector<std::string> TableReader::texts(const std::string& key) {
  const Value* value = take(key);
  if (!value) return {};
  if (value->kind == Value::Kind::Text) return {value->text};
  std::vector<std::string> out;
  if (value->kind != Value::Kind::List) wrong(*value, key, "a string or a list of strings");
  for (const Value& each : value->list)
    if (each.kind == Value::Kind::Text)
      out.push_back(each.text);
    else
      wrong(each, key, "a string or a list of strings");
  return out;
}

std::vector<double> TableReader::numbers(const std::string& key) {
  const Value* value = take(key);
  std::vector<double> out;
  bool good = true;
  if (value) flatten(*value, out, good);
  if (!good) wrong(*value, key, "a number or a list of numbers");
  return out;
}

std::vector<uint32_t> TableReader::sizes(const std::string& key, size_t most) {
  const Value* value = take(key);
  if (!value) return {};
  std::vector<uint32_t> out;
  bool good = value->kind == Value::Kind::Integer ||
              (value->kind == Value::Kind::List && !value->list.empty() && value->list.size() <= most);
  const auto add = [&](const Value& v) {
    good &= v.kind == Value::Kind::Integer && v.whole >= 1 && v.whole <= kMostOfAxis;
    if (good) out.push_back(uint32_t(v.whole));
  };
  if (value->kind == Value::Kind::Integer) add(*value);
  for (const Value& each : value->list) add(each);
  if (good) return out;
  errors_.error(value->where,
                fmt::format("'{}' must be a whole number, or a list of up to {}, each from 1 to {}", key,
                            most, kMostOfAxis));
  return {};
}

std::vector<const Value*> TableReader::tables(const std::string& key) {
  const Value* value = take(key);
  if (!value) return {};
  if (value->kind == Value::Kind::Table) return {value};
  std::vector<const Value*> out;
  if (value->kind != Value::Kind::List) wrong(*value, key, fmt::format("tables: [[{}]]", key));
  for (const Value& each : value->list)
    if (each.kind == Value::Kind::Table)
      out.push_back(&each);
    else
      wrong(each, key, fmt::format("tables: [[{}]]", key));
  return out;
}

void TableReader::finish() {
  const std::vector<std::string> known(known_.begin(), known_.end());
  for (const auto& [key, value] : table_.table) {
    if (known_.count(key)) continue;
    const std::string near = nearest(key, known);
    errors_.error(value.where, fmt::format("'{}' is not a key of {}", key, what_),
                  near.empty() ? fmt::format("the keys are {}", fmt::join(known, ", "))
                               : fmt::format("did you mean '{}'?", near));
  }
}

}  // namespace glint::pipeline
