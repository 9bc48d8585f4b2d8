// Loads from and stores to the lanes' stacks.
// SPDX-License-Identifier: Apache-2.0
#include "exec/local_memory.h"

#include <bit>
#include <cstring>
#include <fmt/format.h>
#include <string>

#include "exec/access_rows.h"
#include "exec/access_words.h"

namespace glint::exec {

using isa::Effect;

// Checks an access() in which a lane is outside of the stack or misaligned. A frame that does not fit is an
// overflow, which nothing lets pass. Lanes that are outside without an overflow leave `lanes`.
bool LocalMemory::check(WarpContext& warp, const isa::OpRow& row, LaneMask& lanes) {
  const uint32_t bytes = row.memory.bytes * row.memory.count, part = row_bytes(row.memory);
  const uint32_t frame = world_.image->shaders[world_.image->shader_of[warp.simt.pc]].local_bytes;
  for (LaneMask rest = lanes; rest; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    Address& address = warp.regs.access.address[size_t(lane)];
    const uint64_t stack_pointer = warp.regs.read(0)[lane];
    const auto what = [&](std::string_view wrong) {
      return fmt::format("{} {} bytes at local address {:#x}{}", verb_of(row.effect), bytes, address, wrong);
    };
    if (address + bytes > world_.local_bytes) {
      const std::string size = fmt::format(": the stack of a lane has {} bytes", world_.local_bytes);
      if (stack_pointer + frame > world_.local_bytes)
        return faults_.fail(
            warp, lane,
            what(fmt::format("{}, and it overflows: {} are in use and the shader's frame takes {}{}", size,
                             stack_pointer, frame,
                             world_.image->functions.empty()
                                 ? ""
                                 : "; 'stack_bytes' of a launch file gives functions of PTX a larger one")));
      if (!faults_.let_pass(warp, lane, FaultKind::OutOfBounds, [&] { return what(size); })) return false;
      lanes &= ~(LaneMask{1} << lane);
    } else if (address % part != 0) {
      if (!faults_.let_pass(warp, lane, FaultKind::Misaligned,
                            [&] { return what(fmt::format(", which is not a multiple of {}", part)); }))
        return false;
      address -= address % part;
    }
  }
  return true;
}

// Runs an access of whole words at one address of every lane's stack: each word is one row of the stack.
void LocalMemory::move_rows(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, Address address,
                            LaneMask lanes) {
  const isa::Memory& shape = row.memory;
  uint32_t* stack = warp.local.data() + address / 4 * kLanes;
  for (uint32_t r = 0; r < rows_of(shape); ++r, stack += kLanes) {
    if (row.effect == Effect::Store)
      copy_lanes(stack, warp.regs.read(slot_of(inst, shape, kStoreFirst, r)), lanes);
    else
      copy_lanes(warp.regs.write(slot_of(inst, shape, kLoadFirst, r)), stack, lanes);
  }
}

// Runs a load or store. Local memory lies word by word, with all lanes of a word together, so a vector may
// start at any word, as spills do.
bool LocalMemory::access(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, LaneMask& made) {
  LaneMask lanes = made;
  const isa::Memory& shape = row.memory;
  const uint32_t bytes = shape.bytes * shape.count, part = row_bytes(shape);
  const Address* const address = warp.regs.access.address.data();
  if (part == 4 && is_uniform(warp.regs.access, lanes)) {
    const Address common = address[std::countr_zero(lanes)];
    if (common % part == 0 && common + bytes <= world_.local_bytes) [[likely]]
      return move_rows(warp, inst, row, common, lanes), true;
  }
  bool all_inside = true;
  for_each_lane(lanes, [&](int lane) {
    all_inside &= address[lane] % part == 0 && address[lane] + bytes <= world_.local_bytes;
  });
  if (!all_inside) [[unlikely]] {
    LaneMask inside = lanes;
    if (!check(warp, row, inside)) return false;
    if (row.effect == Effect::Load) load_zeros(warp, inst, shape, lanes & ~inside);
    lanes = made = inside;
  }
  const bool store = row.effect == Effect::Store;
  uint32_t* const stack = warp.local.data();
  for (uint32_t r = 0; r < rows_of(shape); ++r) {
    const isa::Slot slot = slot_of(inst, shape, store ? kStoreFirst : kLoadFirst, r);
    const auto word = [&](int lane) {
      return stack + (address[lane] + r * part) / 4 * kLanes + size_t(lane);
    };
    const auto byte = [&](int lane) {
      return reinterpret_cast<std::byte*>(word(lane)) + (address[lane] + r * part) % 4;
    };
    if (part == 4 && store) {
      const uint32_t* from = warp.regs.read(slot);
      for_each_lane(lanes, [&](int lane) { *word(lane) = from[lane]; });
    } else if (part == 4) {
      uint32_t* to = warp.regs.write(slot);
      for_each_lane(lanes, [&](int lane) { to[lane] = *word(lane); });
    } else if (store) {
      const uint32_t* from = warp.regs.read(slot);
      for_each_lane(lanes, [&](int lane) { std::memcpy(byte(lane), from + lane, part); });
    } else {
      uint32_t* to = warp.regs.write(slot);
      for_each_lane(lanes, [&](int lane) { to[lane] = narrow(byte(lane), shape); });
    }
  }
  return true;
}

}  // namespace glint::exec
