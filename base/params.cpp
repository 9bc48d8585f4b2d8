// Reads and describes the fields that lists of parameters declare.
// SPDX-License-Identifier: Apache-2.0
#include "base/params.h"

#include <fmt/format.h>
#include <utility>

#include "base/check.h"
#include "base/registry.h"

namespace glint {
namespace {

// Calls `visit` with a reference to the number or truth value at `field`, as the type that `type` names.
template <class Visit>
void visit_value(FieldType type, const void* field, Visit&& visit) {
  switch (type) {
    case FieldType::Bool:
      return visit(*static_cast<const bool*>(field));
    case FieldType::Uint8:
      return visit(*static_cast<const uint8_t*>(field));
    case FieldType::Uint16:
      return visit(*static_cast<const uint16_t*>(field));
    case FieldType::Uint32:
      return visit(*static_cast<const uint32_t*>(field));
    case FieldType::Uint64:
      return visit(*static_cast<const uint64_t*>(field));
    case FieldType::Int32:
      return visit(*static_cast<const int32_t*>(field));
    case FieldType::Float:
      return visit(*static_cast<const float*>(field));
    case FieldType::Double:
      return visit(*static_cast<const double*>(field));
    case FieldType::Choice:
    case FieldType::Section:
    case FieldType::Policy:
      break;
  }
  GLINT_PANIC("field type {} holds no value", int(type));
}

void read_row(ConfigTable& table, void* owner, const ParamRow& row) {
  void* const field = static_cast<char*>(owner) + row.offset;
  if (row.type == FieldType::Choice) {
    std::string& name = *static_cast<std::string*>(field);
    const bool is_given = table.has(row.name);
    name = table.take_name(row.name, name, row.names());
    if (row.apply && is_given) row.apply(owner, std::string(name));
  } else if (row.type == FieldType::Section) {
    ConfigTable sub = table.take_table(row.name);
    read_rows(sub, field, row.section());
  } else if (row.type == FieldType::Policy) {
    registry_of(*row.kind).read(table, row.name, row.choice_of(field));
  } else {
    visit_value(row.type, field, [&]<class T>(const T& value) {
      T& out = *static_cast<T*>(field);
      if constexpr (std::is_same_v<T, bool>)
        out = table.take_bool(row.name, value);
      else if constexpr (std::is_floating_point_v<T>)
        out = T(table.take_number(row.name, double(value), row.least, row.largest, row.unit));
      else
        out = T(table.take_integer(row.name, int64_t(value), row.min, row.max, row.unit));
    });
  }
}

void describe_row(std::vector<ParamInfo>& out, const std::string& prefix, const void* field,
                  const ParamRow& row) {
  const std::string key = prefix + std::string(row.name);
  const auto add = [&](std::string value, std::string range) {
    out.push_back({key, std::string(row.unit), std::string(row.doc), std::move(value), std::move(range)});
  };
  if (row.type == FieldType::Choice) {
    add(config_text(*static_cast<const std::string*>(field)),
        fmt::format("{}", fmt::join(row.names(), ", ")));
  } else if (row.type == FieldType::Section) {
    for (ParamInfo& info : describe_rows(field, row.section(), key + ".")) out.push_back(std::move(info));
  } else if (row.type == FieldType::Policy) {
    const AnyPolicyChoice& choice = row.choice_of(const_cast<void*>(field));
    add(config_text(choice.name), fmt::format("{}", fmt::join(registry_of(*row.kind).list(), ", ")));
    for (ParamInfo& info : describe_choice(choice, prefix, row.name)) out.push_back(std::move(info));
  } else {
    visit_value(row.type, field, [&]<class T>(const T& value) {
      const bool is_float = std::is_floating_point_v<T>;
      add(config_text(value), row.type == FieldType::Bool ? ""
                              : is_float ? config_text(row.least) + " to " + config_text(row.largest)
                                         : config_text(row.min) + " to " + config_text(row.max));
    });
  }
}

}  // namespace

void read_rows(ConfigTable& table, void* owner, const ParamList& rows) {
  for (const ParamRow& row : rows) read_row(table, owner, row);
  table.reject_the_rest();
}

std::vector<ParamInfo> describe_rows(const void* owner, const ParamList& rows, const std::string& prefix) {
  std::vector<ParamInfo> out;
  for (const ParamRow& row : rows)
    describe_row(out, prefix, static_cast<const char*>(owner) + row.offset, row);
  return out;
}

}  // namespace glint
