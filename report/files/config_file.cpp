// Groups dotted keys into TOML tables.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/config_file.h"

#include <algorithm>
#include <fmt/format.h>

namespace glint::report {
namespace {

struct Table {
  std::string name;
  std::vector<const ParamInfo*> params;
};

std::vector<Table> tables_of(const std::vector<ParamInfo>& params) {
  std::vector<Table> tables{{"", {}}};  // Keys without a table must come first in TOML.
  for (const ParamInfo& param : params) {
    if (!param.needs.empty()) continue;
    const size_t dot = param.key.rfind('.');
    const std::string name = dot == std::string::npos ? "" : param.key.substr(0, dot);
    auto table = std::find_if(tables.begin(), tables.end(), [&](const Table& t) { return t.name == name; });
    if (table == tables.end()) table = tables.insert(tables.end(), {name, {}});
    table->params.push_back(&param);
  }
  return tables;
}

std::string comment_of(const ParamInfo& param) {
  std::string text = param.doc;
  if (!param.unit.empty()) text = fmt::format("[{}] {}", param.unit, text);
  if (!param.range.empty()) text += fmt::format(" ({})", param.range);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

std::string config_file(const std::vector<ParamInfo>& params, const std::string& title, bool with_docs) {
  std::string out = fmt::format("# {}\n", title);
  for (const Table& table : tables_of(params)) {
    if (table.params.empty()) continue;
    if (!table.name.empty()) out += fmt::format("\n[{}]\n", table.name);
    size_t width = 0;
    for (const ParamInfo* param : table.params)
      width = std::max(width, param->key.size() - param->key.rfind('.') - 1 + 3 + param->value.size());
    for (const ParamInfo* param : table.params) {
      const std::string assignment = param->key.substr(param->key.rfind('.') + 1) + " = " + param->value;
      out += with_docs ? fmt::format("{:<{}}  # {}\n", assignment, width, comment_of(*param))
                       : assignment + "\n";
    }
  }
  return out;
}

std::string config_key_values(const std::vector<ParamInfo>& params) {
  std::string out;
  for (const ParamInfo& param : params)
    if (param.needs.empty()) out += param.key + "=" + param.value + "\n";
  return out;
}

uint64_t fnv1a(const std::string& bytes) {
  uint64_t hash = 0xcbf29ce484222325;                                     // FNV's offset basis
  for (const char c : bytes) hash = (hash ^ uint8_t(c)) * 0x100000001b3;  // FNV's prime
  return hash;
}

}  // namespace glint::report
