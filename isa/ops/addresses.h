// Holds the handlers of loads, stores and atomics, which form addresses.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "isa/op_makers.h"

namespace glint::isa::GLINT_ISA_PATH {

// Writes the addresses of all lanes; those of lanes outside exec are ignored. Operand kSlot is the base.
// 64-bit bases wrap modulo 2^64, and 32-bit bases modulo 2^32.
template <class Base, int kSlot>
[[gnu::flatten]] void form_addresses(Warp& warp, const Inst& inst, const OpRow&) {
  const Source<Base> base(warp, *(&inst.operand.front() + kSlot));
  Address* const out = &warp.access.address.front();
  const Base displacement = Base(int64_t(inst.imm));
  all_lanes([&](int i) { out[i] = Address(Base(base.at(i) + displacement)); });
}

}  // namespace glint::isa::GLINT_ISA_PATH
