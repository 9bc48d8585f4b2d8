// Holds a TOML file as a tree of values that know their places, and reads its tables by type.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace glint::pipeline {

struct Entry;  // a key and its value

struct Value {
  enum class Kind : uint8_t { None, Bool, Integer, Real, Text, List, Table } kind = Kind::None;
  bool flag = false;
  int64_t whole = 0;
  double real = 0;  // set for integers, too
  std::string text;
  std::vector<Value> list;
  std::vector<Entry> table;  // ordered by line
  SourceLocation where;      // place of the key, or of a value in a list

  explicit operator bool() const { return kind != Kind::None; }
  bool is_number() const { return kind == Kind::Integer || kind == Kind::Real; }
  const Value* find(const std::string& key) const;  // null when absent
};

// This is the most along an axis of a launch or a picture: CUDA's limit of a grid's x.
inline constexpr int64_t kMostOfAxis = 0x7fff'ffff;

struct Entry {
  std::string key;
  Value value;
};

// Reads a TOML file or text. Throws UserError with line and column when it cannot be read or is not TOML.
Value read_toml(const std::string& path);
Value parse_toml(const std::string& text, const std::string& name);

// Reads one table. Each call marks its key as known, and finish() reports the other keys, with the nearest
// known key for each. Wrong types are reported at once, and the call then returns the fallback.
class TableReader {
 public:
  // `what` names the table in messages, such as "a buffer".
  TableReader(const Value& table, std::string what, Diagnostics& errors);

  const Value* take(const std::string& key);  // null when absent
  std::string text(const std::string& key, const std::string& fallback = {});
  std::string required_text(const std::string& key);
  std::string name(const std::string& key, const std::string& fallback,
                   const std::vector<std::string>& names);
  int64_t integer(const std::string& key, int64_t fallback, int64_t least, int64_t most);
  std::optional<int64_t> optional_integer(const std::string& key, int64_t least, int64_t most);
  double number(const std::string& key, double fallback);
  bool flag(const std::string& key, bool fallback);
  std::vector<std::string> texts(const std::string& key);  // a string or a list of strings
  std::vector<double> numbers(const std::string& key);     // a number or a list; lists in lists are flattened
  // Reads one number, or up to `most` of them. Each is from 1 to kMostOfAxis.
  std::vector<uint32_t> sizes(const std::string& key, size_t most);
  std::vector<const Value*> tables(const std::string& key);  // [[key]] or [key]
  void finish();
  const SourceLocation& where() const { return table_.where; }

 private:
  void wrong(const Value& value, const std::string& key, const std::string& expected);

  const Value& table_;
  const std::string what_;
  Diagnostics& errors_;
  std::set<std::string> known_;
};

}  // namespace glint::pipeline
