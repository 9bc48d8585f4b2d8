// Names accesses and spaces for messages about faults.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <iterator>
#include <string_view>

#include "isa/op_row.h"

namespace glint::exec {

inline std::string_view verb_of(isa::Effect effect) {
  return effect == isa::Effect::Load ? "reads" : effect == isa::Effect::Store ? "writes" : "changes";
}
inline std::string_view name_of(isa::Space space) {
  constexpr std::string_view kNames[] = {"", "global", "local", "shared", "constant", "parameter", "generic"};
  static_assert(std::size(kNames) == size_t(isa::Space::Generic) + 1);
  return kNames[size_t(space)];
}

}  // namespace glint::exec
