// Holds pieces of programs that tests of a core's cycles share.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstdint>

#include "tests/unit/core/one_core.h"

namespace glint::core {

inline uint64_t stall(const OneCore& core, Stall reason) {
  return core.stats().stalls.count(reason);
}

// Sets %rd2 = base + lane * stride, which takes 4 cycles from cycle 0 on.
inline void add_address(Code& code, Address base, uint32_t stride) {
  code.add("mad.wide.u32",
           {reg(2), special(isa::Special::LaneId), code.constant(stride), code.constant64(base)});
}

// Adds an rt.trace of one ray per lane into `structure`.
inline void add_trace(Code& code, isa::Slot structure) {
  const isa::Slot zero = code.constant(0), one = code.constant(std::bit_cast<uint32_t>(1.0f));
  code.add("rt.trace", {0, structure, zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, one,
                        one, zero, zero});
}

// Allocates a top level that rays may enter. The RT unit of these tests does not read it.
inline Address allocate_structure(mem::AddressSpace& memory) {
  const Address at = memory.allocate("structure", 4096);
  rt::StructureHeader header;
  header.level = 1;
  header.format = rt::format_id("bvh6");
  memory.write(at, &header, sizeof header);
  return at;
}

}  // namespace glint::core
