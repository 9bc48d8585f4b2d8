// Generic addresses: one 64-bit space in which shared, local and constant memory have windows; the rest is
// global.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "isa/op_row.h"
#include "isa/program.h"

namespace glint::isa {

// Windows of 4 GiB at the top of the positive addresses, far from every allocation of global memory.
// Choice: PTX leaves the places open.
inline constexpr uint64_t kWindowBytes = uint64_t{1} << 32;
inline constexpr uint64_t kConstWindow = 0x7fff'fffd'0000'0000;
inline constexpr uint64_t kSharedWindow = kConstWindow + kWindowBytes;
inline constexpr uint64_t kLocalWindow = kSharedWindow + kWindowBytes;
inline constexpr uint64_t kParamWindow =
    kConstWindow + kPushConstantOffset;  // parameters lie in the constant bank

// What an address of the space has to have added to become generic.
constexpr uint64_t window_of(Space space) {
  return space == Space::Shared  ? kSharedWindow
         : space == Space::Local ? kLocalWindow
         : space == Space::Const ? kConstWindow
         : space == Space::Param ? kParamWindow
                                 : 0;
}

// The space a generic address is in; its address there is the low 32 bits, all 64 in global memory.
constexpr Space space_of(uint64_t generic) {
  switch (generic / kWindowBytes) {
    case kConstWindow / kWindowBytes:
      return Space::Const;
    case kSharedWindow / kWindowBytes:
      return Space::Shared;
    case kLocalWindow / kWindowBytes:
      return Space::Local;
    default:
      return Space::Global;
  }
}

}  // namespace glint::isa
