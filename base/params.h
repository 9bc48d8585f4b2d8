// Declares parameters: one declaration gives the default, the TOML key, the legal range, the unit and the
// doc.
//
//   struct Params {
//     uint32_t warps = 32;
//     std::string scheduler = "gto";
//     UnitParams sfu;
//     static constexpr auto params() {
//       return std::tuple{param(&Params::warps, "warps", "warp", "Number of resident warps.", 1, 64),
//                         choice(&Params::scheduler, "scheduler", "Issue policy.", &policy_names),
//                         section(&Params::sfu, "sfu", "Special-function unit.")};
//     }
//   };
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/config.h"

namespace glint {

// Declares an integer, floating-point or boolean field with an inclusive legal range.
template <class Owner, class T>
struct Param {
  T Owner::*field;
  std::string_view name, unit, doc;
  T min, max;
};
// These are factory functions because clang 14 cannot deduce the template arguments of an aggregate.
template <class Owner, class T>
constexpr Param<Owner, T> param(T Owner::*field, std::string_view name, std::string_view unit,
                                std::string_view doc, std::type_identity_t<T> min,
                                std::type_identity_t<T> max) {
  return {field, name, unit, doc, min, max};
}
template <class Owner>
constexpr Param<Owner, bool> flag(bool Owner::*field, std::string_view name, std::string_view doc) {
  return {field, name, "", doc, false, true};
}

// Declares a field that names an entry of a list that is known only at run time, such as the registered
// policies.
template <class Owner>
struct Choice {
  std::string Owner::*field;
  std::string_view name, doc;
  std::vector<std::string> (*names)();
};
template <class Owner>
constexpr Choice<Owner> choice(std::string Owner::*field, std::string_view name, std::string_view doc,
                               std::vector<std::string> (*names)()) {
  return {field, name, doc, names};
}

// Declares a nested struct with its own params(), which is a table in TOML.
template <class Owner, class T>
struct Section {
  T Owner::*field;
  std::string_view name, doc;
};
template <class Owner, class T>
constexpr Section<Owner, T> section(T Owner::*field, std::string_view name, std::string_view doc) {
  return {field, name, doc};
}

// Describes one key for `glint describe` and docs/config.md. `needs` is set for a parameter of a policy that
// is not chosen: it names the choice that would give the key a meaning. Such a key has no effect and is
// absent from resolved configurations.
struct ParamInfo {
  std::string key, unit, doc, value, range, needs = {};
};

template <class Owner, class T>
void read_param(ConfigTable& table, Owner& out, const Param<Owner, T>& p) {
  if constexpr (std::is_same_v<T, bool>)
    out.*p.field = table.take_bool(p.name, out.*p.field);
  else if constexpr (std::is_floating_point_v<T>)
    out.*p.field = T(table.take_number(p.name, double(out.*p.field), double(p.min), double(p.max), p.unit));
  else
    out.*p.field =
        T(table.take_integer(p.name, int64_t(out.*p.field), int64_t(p.min), int64_t(p.max), p.unit));
}
template <class Owner>
void read_param(ConfigTable& table, Owner& out, const Choice<Owner>& c) {
  out.*c.field = table.take_name(c.name, out.*c.field, c.names());
}
template <class Owner, class T>
void read_param(ConfigTable& table, Owner& out, const Section<Owner, T>& s);

template <class Owner, class T>
void describe_param(std::vector<ParamInfo>& out, const std::string& prefix, const Owner& o,
                    const Param<Owner, T>& p) {
  ParamInfo info{prefix + std::string(p.name), std::string(p.unit), std::string(p.doc),
                 config_text(o.*p.field), ""};
  if constexpr (!std::is_same_v<T, bool>) info.range = config_text(p.min) + " to " + config_text(p.max);
  out.push_back(std::move(info));
}
template <class Owner>
void describe_param(std::vector<ParamInfo>& out, const std::string& prefix, const Owner& o,
                    const Choice<Owner>& c) {
  std::string range;
  for (const std::string& name : c.names()) range += (range.empty() ? "" : ", ") + name;
  out.push_back({prefix + std::string(c.name), "", std::string(c.doc), config_text(o.*c.field), range});
}
template <class Owner, class T>
void describe_param(std::vector<ParamInfo>& out, const std::string& prefix, const Owner& o,
                    const Section<Owner, T>& s);

// Calls find read_param and describe_param by argument-dependent lookup, so registry.h can add PolicyParam.

// Fills `out` from the table. A field whose key is absent keeps its value. Wrong types, values out of range
// and undeclared keys are collected in the table's Diagnostics.
template <class P>
void read_params(ConfigTable& table, P& out) {
  std::apply([&](const auto&... p) { (read_param(table, out, p), ...); }, P::params());
  table.reject_the_rest();
}

// Returns every key of P with its present value, in declaration order. Nested keys are written "section.key".
template <class P>
std::vector<ParamInfo> describe_params(const P& values, const std::string& prefix = {}) {
  std::vector<ParamInfo> out;
  std::apply([&](const auto&... p) { (describe_param(out, prefix, values, p), ...); }, P::params());
  return out;
}

template <class Owner, class T>
void read_param(ConfigTable& table, Owner& out, const Section<Owner, T>& s) {
  ConfigTable sub = table.take_table(s.name);
  read_params(sub, out.*s.field);
}
template <class Owner, class T>
void describe_param(std::vector<ParamInfo>& out, const std::string& prefix, const Owner& o,
                    const Section<Owner, T>& s) {
  for (ParamInfo& info : describe_params(o.*s.field, prefix + std::string(s.name) + "."))
    out.push_back(std::move(info));
}

}  // namespace glint
