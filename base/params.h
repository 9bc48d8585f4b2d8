// Declares parameters: one declaration gives the default, the TOML key, the legal range, the unit and the
// doc.
//
//   struct Params {
//     uint32_t warps = 32;
//     std::string scheduler = "gto";
//     UnitParams sfu;
//     static ParamList params() {
//       return {param(&Params::warps, "warps", "warp", "Number of resident warps.", 1, 64),
//               choice(&Params::scheduler, "scheduler", "Issue policy.", &policy_names),
//               section(&Params::sfu, "sfu", "Special-function unit.")};
//     }
//   };
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/config.h"

namespace glint {

struct AnyPolicyChoice;
struct PolicyKind;
struct ParamRow;
using ParamList = std::vector<ParamRow>;

// Names the types that a declared field can have.
enum class FieldType : uint8_t {
  Bool,
  Uint8,
  Uint16,
  Uint32,
  Uint64,
  Int32,
  Float,
  Double,
  Choice,
  Section,
  Policy
};

// Returns the type of a field that holds a number or a truth value.
template <class T>
constexpr FieldType field_type() {
  if constexpr (std::is_same_v<T, bool>) return FieldType::Bool;
  if constexpr (std::is_same_v<T, uint8_t>) return FieldType::Uint8;
  if constexpr (std::is_same_v<T, uint16_t>) return FieldType::Uint16;
  if constexpr (std::is_same_v<T, uint32_t>) return FieldType::Uint32;
  if constexpr (std::is_same_v<T, uint64_t>) return FieldType::Uint64;
  if constexpr (std::is_same_v<T, int32_t>) return FieldType::Int32;
  if constexpr (std::is_same_v<T, float>) return FieldType::Float;
  if constexpr (std::is_same_v<T, double>) return FieldType::Double;
}

// Holds the declaration of one field. It is the same type for every struct, so that a list of declarations
// costs the compiler little; params.cpp reads and describes it.
struct ParamRow {
  std::string_view name, unit, doc;
  FieldType type;
  std::ptrdiff_t offset;  // bytes from the beginning of the struct to the field
  // The limits include their ends. Integers have the first pair, floating-point numbers the second.
  int64_t min = 0, max = 0;
  double least = 0, largest = 0;
  std::vector<std::string> (*names)() = nullptr;                // of FieldType::Choice
  void (*apply)(void* owner, std::string_view name) = nullptr;  // of preset()
  ParamList (*section)() = nullptr;                             // of FieldType::Section
  const PolicyKind* kind = nullptr;                             // of FieldType::Policy
  AnyPolicyChoice& (*choice_of)(void* field) = nullptr;         // of FieldType::Policy
};

// Returns the bytes from the beginning of the struct to the field. A pointer to a data member is that number
// in the Itanium C++ ABI (section 2.3.1), which every compiler on Linux follows.
template <class Owner, class T>
std::ptrdiff_t offset_of(T Owner::*field) {
  return std::bit_cast<std::ptrdiff_t>(field);
}

// Declares an integer or floating-point field with an inclusive legal range.
template <class Owner, class T>
ParamRow param(T Owner::*field, std::string_view name, std::string_view unit, std::string_view doc,
               std::type_identity_t<T> min, std::type_identity_t<T> max) {
  ParamRow row{name, unit, doc, field_type<T>(), offset_of(field)};
  if constexpr (std::is_floating_point_v<T>)
    row.least = double(min), row.largest = double(max);
  else
    row.min = int64_t(min), row.max = int64_t(max);
  return row;
}

// Declares a field that is true or false.
template <class Owner>
ParamRow flag(bool Owner::*field, std::string_view name, std::string_view doc) {
  return {name, "", doc, FieldType::Bool, offset_of(field)};
}

// Declares a field that names an entry of a list that is known only at run time.
template <class Owner>
ParamRow choice(std::string Owner::*field, std::string_view name, std::string_view doc,
                std::vector<std::string> (*names)()) {
  ParamRow row{name, "", doc, FieldType::Choice, offset_of(field)};
  row.names = names;
  return row;
}

// Declares a field that names a set of values for other fields. When a file gives the key, kApply(Owner&,
// name) sets them; a key of a later row wins over the set.
template <auto kApply, class Owner>
ParamRow preset(std::string Owner::*field, std::string_view name, std::string_view doc,
                std::vector<std::string> (*names)()) {
  ParamRow row = choice(field, name, doc, names);
  row.apply = [](void* owner, std::string_view chosen) { kApply(*static_cast<Owner*>(owner), chosen); };
  return row;
}

// Declares a nested struct with its own params(), which is a table in TOML.
template <class Owner, class T>
ParamRow section(T Owner::*field, std::string_view name, std::string_view doc) {
  ParamRow row{name, "", doc, FieldType::Section, offset_of(field)};
  row.section = &T::params;
  return row;
}

// policy() in registry.h declares a field that chooses a policy.

// Describes one key for `glint describe` and docs/config.md. `needs` is set for a parameter of a policy that
// is not chosen: it names the choice that would give the key a meaning. Such a key has no effect and is
// absent from resolved configurations.
struct ParamInfo {
  std::string key, unit, doc, value, range, needs = {};
};

// These do what the templates below say, for the struct at `owner` that `rows` declares.
void read_rows(ConfigTable& table, void* owner, const ParamList& rows);
std::vector<ParamInfo> describe_rows(const void* owner, const ParamList& rows, const std::string& prefix);

// Fills `out` from the table. A field whose key is absent keeps its value. Wrong types, values out of range
// and undeclared keys are collected in the table's Diagnostics.
template <class P>
void read_params(ConfigTable& table, P& out) {
  read_rows(table, &out, P::params());
}

// Returns every key of P with its present value, in declaration order. Nested keys are written "section.key".
template <class P>
std::vector<ParamInfo> describe_params(const P& values, const std::string& prefix = {}) {
  return describe_rows(&values, P::params(), prefix);
}

}  // namespace glint
