// Loads and stores: moving data between a warp's registers and simulated memory, with every access checked.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstring>

#include "base/check.h"
#include "core/executor.h"

namespace glint::core {
namespace {

// Slot of the first value operand: loads write from slot 0, stores read after the address.
constexpr size_t kLoadFirst = 0, kStoreFirst = 1;

uint32_t narrow(const std::byte* from, const isa::Memory& shape) {
  uint32_t value = 0;
  std::memcpy(&value, from, shape.bytes);
  if (!shape.sign_extend) return value;
  return shape.bytes == 1 ? uint32_t(int32_t(int8_t(value))) : uint32_t(int32_t(int16_t(value)));
}

// Words of 32 bits that an access moves a lane; 0 for parts narrower than a word.
uint32_t words_of(const isa::Memory& shape) { return shape.bytes * shape.count / 4u; }

// Register row of word `word`: a pair for 64-bit values, any registers for vectors.
isa::Slot slot_of(const isa::Inst& inst, const isa::Memory& shape, size_t first, uint32_t word) {
  return shape.bytes == 8 ? isa::Slot(inst.operand[first + word / 2] + word % 2) : inst.operand[first + word];
}

}  // namespace

bool Executor::run_memory(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  GLINT_CHECK(row.effect != isa::Effect::Atomic, "{}: atomics are not executed yet", row.name);
  row.run(warp.regs, inst);
  const bool store = row.effect == isa::Effect::Store;
  bool ok = false;
  switch (row.memory.space) {
    case isa::Space::Global: ok = store ? store_global(warp, inst, row) : load_global(warp, inst, row); break;
    case isa::Space::Local: ok = access_local(warp, inst, row, store); break;
    case isa::Space::Const: ok = load_constant(warp, inst, row); break;
    case isa::Space::Shared:
    case isa::Space::Param:
    case isa::Space::Generic:
    case isa::Space::None: GLINT_PANIC("{}: no such space", row.name);
  }
  if (ok) ++warp.simt.pc;
  return ok;
}

bool Executor::load_global(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  const isa::Memory& shape = row.memory;
  const uint32_t bytes = shape.bytes * shape.count, words = words_of(shape);
  std::array<const std::byte*, kLanes> from;
  for (LaneMask lanes = warp.regs.exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const Address address = warp.regs.access.address[size_t(lane)];
    const std::byte* at = world_.memory->find(address, bytes);
    if (!at) [[unlikely]]
      return fail(warp, lane, fmt::format("reads {} bytes at {:#x}: {}", bytes, address, world_.memory->explain(address, bytes)));
    from[size_t(lane)] = at;
  }
  if (words == 0) {
    uint32_t* to = warp.regs.write(inst.operand[kLoadFirst]);
    for_each_lane(warp.regs.exec, [&](int lane) { to[lane] = narrow(from[size_t(lane)], shape); });
    return true;
  }
  for (uint32_t word = 0; word < words; ++word) {
    uint32_t* to = warp.regs.write(slot_of(inst, shape, kLoadFirst, word));
    for_each_lane(warp.regs.exec, [&](int lane) { std::memcpy(to + lane, from[size_t(lane)] + word * 4, 4); });
  }
  return true;
}

bool Executor::store_global(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  const isa::Memory& shape = row.memory;
  const uint32_t bytes = shape.bytes * shape.count, words = words_of(shape);
  std::array<std::byte*, kLanes> to;
  for (LaneMask lanes = warp.regs.exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const Address address = warp.regs.access.address[size_t(lane)];
    to[size_t(lane)] = world_.memory->find(address, bytes);
    if (!to[size_t(lane)]) [[unlikely]]
      return fail(warp, lane, fmt::format("writes {} bytes at {:#x}: {}", bytes, address, world_.memory->explain(address, bytes)));
  }
  // Lane by lane: where two lanes write one place, the higher lane's value stays. Choice: PTX leaves it open.
  for_each_lane(warp.regs.exec, [&](int lane) {
    if (words == 0) std::memcpy(to[size_t(lane)], warp.regs.read(inst.operand[kStoreFirst]) + lane, shape.bytes);
    for (uint32_t word = 0; word < words; ++word)
      std::memcpy(to[size_t(lane)] + word * 4, warp.regs.read(slot_of(inst, shape, kStoreFirst, word)) + lane, 4);
  });
  return true;
}

bool Executor::access_local(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, bool store) {
  const isa::Memory& shape = row.memory;
  const uint32_t words = words_of(shape), bytes = words * 4;
  for (LaneMask lanes = warp.regs.exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const Address address = warp.regs.access.address[size_t(lane)];
    if (address % 4 != 0 || address + bytes > world_.local_bytes) [[unlikely]]
      return fail(warp, lane, fmt::format("{} {} bytes at local address {:#x}: the stack of a lane has {} bytes",
                                          store ? "writes" : "reads", bytes, address, world_.local_bytes));
  }
  const Address* const address = warp.regs.access.address.data();
  for (uint32_t word = 0; word < words; ++word) {
    // Word `word` of a lane: its address counts bytes of one lane, rows hold kLanes words.
    uint32_t* const stack = warp.local.data() + size_t(word) * kLanes;
    if (store) {
      const uint32_t* from = warp.regs.read(slot_of(inst, shape, kStoreFirst, word));
      for_each_lane(warp.regs.exec, [&](int lane) { stack[address[lane] / 4 * kLanes + size_t(lane)] = from[lane]; });
    } else {
      uint32_t* to = warp.regs.write(slot_of(inst, shape, kLoadFirst, word));
      for_each_lane(warp.regs.exec, [&](int lane) { to[lane] = stack[address[lane] / 4 * kLanes + size_t(lane)]; });
    }
  }
  return true;
}

bool Executor::load_constant(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  const isa::Memory& shape = row.memory;
  const uint32_t words = words_of(shape), bytes = words * 4;
  for (LaneMask lanes = warp.regs.exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const Address address = warp.regs.access.address[size_t(lane)];
    if (address + bytes > world_.constant_bank.size()) [[unlikely]]
      return fail(warp, lane, fmt::format("reads {} bytes at constant address {:#x}: the bank has {} bytes", bytes, address,
                                          world_.constant_bank.size()));
    for (uint32_t word = 0; word < words; ++word)
      std::memcpy(warp.regs.write(slot_of(inst, shape, kLoadFirst, word)) + lane,
                  world_.constant_bank.data() + address + word * 4, 4);
  }
  return true;
}

}  // namespace glint::core
