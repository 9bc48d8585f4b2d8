// Finds the registers of a load, a store or an atomic: which rows it fills or reads, and each lane's part.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "base/types.h"
#include "exec/warp_context.h"
#include "isa/op_row.h"

namespace glint::exec {

// Says where the data of each lane lies.
using LanePlaces = std::array<std::byte*, kLanes>;

// These are the slots of the first value operand: loads write from slot 0, and stores read after the address.
inline constexpr size_t kLoadFirst = 0, kStoreFirst = 1;

inline uint32_t narrow(const std::byte* from, const isa::Memory& shape) {
  uint32_t value = 0;
  std::memcpy(&value, from, shape.bytes);
  if (!shape.sign_extend) return value;
  return shape.bytes == 1 ? uint32_t(int32_t(int8_t(value))) : uint32_t(int32_t(int16_t(value)));
}

// Returns the number of registers per lane that an access fills or reads: one per part, or two for parts of 8
// bytes.
inline uint32_t rows_of(const isa::Memory& shape) {
  return shape.bytes == 8 ? 2u * shape.count : shape.count;
}
// Returns the bytes of each part in memory.
inline uint32_t row_bytes(const isa::Memory& shape) {
  return shape.bytes == 8 ? 4u : shape.bytes;
}
// Returns the register that a part of a load fills, from the bytes of the part.
inline uint32_t part_of(const std::byte* from, const isa::Memory& shape) {
  if (row_bytes(shape) != 4) return narrow(from, shape);
  uint32_t value = 0;
  std::memcpy(&value, from, 4);
  return value;
}
// Returns the register row of row `row`: a pair for 64-bit values, any registers for vectors.
inline isa::Slot slot_of(const isa::Inst& inst, const isa::Memory& shape, size_t first, uint32_t row) {
  return shape.bytes == 8 ? isa::Slot(inst.operand[first] + row) : inst.operand[first + row];
}

// Returns whether all of `lanes`, of which there is one at least, have one address. That is so in most
// accesses to local memory and to the constant bank.
inline bool is_uniform(const isa::Access& access, LaneMask lanes) {
  const Address first = access.address[size_t(std::countr_zero(lanes))];
  Address differ = 0;
  if (lanes == kAllLanes)
    for (const Address address : access.address) differ |= address ^ first;
  else
    for_each_lane(lanes, [&](int lane) { differ |= access.address[size_t(lane)] ^ first; });
  return differ == 0;
}

// Copies the words of `lanes` from one row to another.
inline void copy_lanes(uint32_t* to, const uint32_t* from, LaneMask lanes) {
  if (lanes == kAllLanes)
    std::memcpy(to, from, sizeof(uint32_t) * size_t(kLanes));
  else
    for_each_lane(lanes, [&](int lane) { to[lane] = from[lane]; });
}

template <class Byte>  // Byte may be const.
void load_rows(WarpContext& warp, const isa::Inst& inst, const isa::Memory& shape, LaneMask lanes,
               const std::array<Byte*, kLanes>& from) {
  const uint32_t bytes = row_bytes(shape);
  for (uint32_t row = 0; row < rows_of(shape); ++row) {
    uint32_t* to = warp.regs.write(slot_of(inst, shape, kLoadFirst, row));
    if (bytes == 4)
      for_each_lane(lanes, [&](int lane) { std::memcpy(to + lane, from[size_t(lane)] + row * 4, 4); });
    else
      for_each_lane(lanes, [&](int lane) { to[lane] = narrow(from[size_t(lane)] + row * bytes, shape); });
  }
}

// Writes the answer of a load or an atomic that went nowhere.
inline void load_zeros(WarpContext& warp, const isa::Inst& inst, const isa::Memory& shape, LaneMask lanes) {
  for (uint32_t row = 0; row < rows_of(shape); ++row) {
    uint32_t* const to = warp.regs.write(slot_of(inst, shape, kLoadFirst, row));
    for_each_lane(lanes, [&](int lane) { to[lane] = 0; });
  }
}

inline uint64_t read_operand(const isa::Warp& regs, isa::Slot slot, int lane, uint32_t bytes) {
  const uint32_t* const low = regs.read(slot);
  if (bytes == 8) return low[lane] | uint64_t(low[kLanes + lane]) << 32;
  return bytes == 2 ? low[lane] & 0xffffu : low[lane];
}

}  // namespace glint::exec
