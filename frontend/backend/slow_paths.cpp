// Names the ops that hardware computes by a short sequence for most operands and by a call for the others.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/slow_paths.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <vector>

#include "isa/op_row.h"

namespace glint::frontend {
namespace {

bool is_named(std::string_view name) {
  constexpr std::string_view kRounded[] = {"div.r", "rcp.r", "sqrt.r"};
  const auto begins = [&](std::string_view start) { return name.starts_with(start); };
  const bool is_rounded = std::any_of(std::begin(kRounded), std::end(kRounded), begins);
  if (is_rounded) return name.ends_with(".f32") || name.ends_with(".f64");
  return (begins("div.") || begins("rem.")) && (name.ends_with(".s64") || name.ends_with(".u64"));
}

}  // namespace

bool has_slow_path(uint16_t op) {
  static const std::vector<bool> known = [] {
    std::vector<bool> out;
    for (const isa::OpRow& row : isa::op_table()) out.push_back(is_named(row.name));
    return out;
  }();
  return known[op];
}

}  // namespace glint::frontend
