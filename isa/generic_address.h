// Defines generic addresses: a 64-bit space in which shared, local and constant memory have windows. All
// other addresses are global.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "isa/op_row.h"
#include "isa/program.h"

namespace glint::isa {

// The windows have 4 GiB each and lie at the top of the positive addresses, far from every allocation of
// global memory. Choice: PTX leaves their places open.
inline constexpr uint64_t kWindowBytes = uint64_t{1} << 32;
inline constexpr uint64_t kConstWindow = 0x7fff'fffd'0000'0000;
inline constexpr uint64_t kSharedWindow = kConstWindow + kWindowBytes;
inline constexpr uint64_t kLocalWindow = kSharedWindow + kWindowBytes;
// The parameters lie in the constant bank.
inline constexpr uint64_t kParamWindow = kConstWindow + kPushConstantOffset;

// Returns what is added to an address of the space to make it generic.
constexpr uint64_t window_of(Space space) {
  return space == Space::Shared  ? kSharedWindow
         : space == Space::Local ? kLocalWindow
         : space == Space::Const ? kConstWindow
         : space == Space::Param ? kParamWindow
                                 : 0;
}

// Returns the space of a generic address. The address in that space is its low 32 bits, or all 64 bits for
// global memory.
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
