// Where the descriptor of a (set, binding) lies in the constant bank.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "isa/program.h"

namespace glint::isa {

// The first kBindingsPerSet bindings of all sets come first, then push constants; the others follow in a part of their
// own, so that worlds without them have a small bank.
inline constexpr uint32_t kMaxBindings = 1024;
inline constexpr uint32_t kMoreBindingsOffset = 32 * 1024;
inline constexpr uint32_t kLargestBankBytes = kMoreBindingsOffset + kMaxSets * (kMaxBindings - kBindingsPerSet) * kDescriptorBytes;
static_assert(kMoreBindingsOffset >= kConstantBankBytes);

constexpr uint32_t descriptor_offset(uint32_t set, uint32_t binding) {
  if (binding < kBindingsPerSet) return set * kSetBytes + binding * kDescriptorBytes;
  return kMoreBindingsOffset + (set * (kMaxBindings - kBindingsPerSet) + binding - kBindingsPerSet) * kDescriptorBytes;
}

}  // namespace glint::isa
