// Computes where the descriptor of a (set, binding) lies in the constant bank.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "isa/program.h"

namespace glint::isa {

// The first kBindingsPerSet bindings of all sets come first, then push constants. The other bindings follow
// in a part of their own, so that worlds without them have a small bank.
inline constexpr uint32_t kMaxBindings = 1024;
inline constexpr uint32_t kMoreBindingsOffset = 32 * 1024;
inline constexpr uint32_t kLargestBankBytes =
    kMoreBindingsOffset + kMaxSets * (kMaxBindings - kBindingsPerSet) * kDescriptorBytes;
static_assert(kMoreBindingsOffset >= kConstantBankBytes);

constexpr uint32_t descriptor_offset(uint32_t set, uint32_t binding) {
  if (binding < kBindingsPerSet) return set * kSetBytes + binding * kDescriptorBytes;
  return kMoreBindingsOffset +
         (set * (kMaxBindings - kBindingsPerSet) + binding - kBindingsPerSet) * kDescriptorBytes;
}

// Gives the address in a descriptor that nobody bound. Programs practically never compute such an address.
// Its (set, binding) can be recovered if at most 32 GiB are added or subtracted.
inline constexpr uint64_t kUnboundBase = 0xfff8'0000'0000'0000;
inline constexpr int kUnboundPlaceShift = 36;
constexpr uint64_t unbound_address(uint32_t set, uint32_t binding) {
  return kUnboundBase + (uint64_t{set * kMaxBindings + binding} << kUnboundPlaceShift);
}
struct UnboundPlace {
  uint32_t set, binding;
};
constexpr std::optional<UnboundPlace> unbound_place(uint64_t address) {
  const uint64_t place =
      (address - kUnboundBase + (uint64_t{1} << (kUnboundPlaceShift - 1))) >> kUnboundPlaceShift;
  if (place >= uint64_t{kMaxSets} * kMaxBindings) return std::nullopt;
  return UnboundPlace{uint32_t(place / kMaxBindings), uint32_t(place % kMaxBindings)};
}

// Gives the address in a descriptor of nothing (Vulkan's nullDescriptor): loads from it give 0, stores to it
// are dropped, and neither is a fault. At most kNullReach bytes may be added or subtracted.
inline constexpr uint64_t kNullAddress = 0xfffe'0000'0000'0000, kNullReach = uint64_t{1} << 48;
constexpr bool is_null_address(uint64_t address) {
  return address - (kNullAddress - kNullReach) < 2 * kNullReach;
}
static_assert(unbound_address(kMaxSets, 0) <= kNullAddress - kNullReach);

}  // namespace glint::isa
