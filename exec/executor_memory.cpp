// Loads, stores and atomics: moving data between a warp's registers and simulated memory, with every access
// checked.
// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <fmt/format.h>

#include "base/check.h"
#include "exec/access_rows.h"
#include "exec/executor.h"
#include "isa/descriptors.h"
#include "isa/generic_address.h"

namespace glint::exec {

using isa::Effect;
using isa::Space;

namespace {

std::string_view verb_of(Effect effect) {
  return effect == Effect::Load ? "reads" : effect == Effect::Store ? "writes" : "changes";
}
std::string_view name_of(Space space) {
  constexpr std::string_view kNames[] = {"", "global", "local", "shared", "constant", "parameter", "generic"};
  return kNames[size_t(space)];
}

// Lane by lane: where two lanes write one place, the higher lane's value stays. Choice: PTX leaves it open.
void store_rows(const WarpContext& warp, const isa::Inst& inst, const isa::Memory& shape, LaneMask lanes,
                const std::array<std::byte*, kLanes>& to) {
  const uint32_t bytes = row_bytes(shape);
  for_each_lane(lanes, [&](int lane) {
    for (uint32_t row = 0; row < rows_of(shape); ++row)
      std::memcpy(to[size_t(lane)] + row * bytes,
                  warp.regs.read(slot_of(inst, shape, kStoreFirst, row)) + lane, bytes);
  });
}

// What a load or an atomic answers that went nowhere.
void load_zeros(WarpContext& warp, const isa::Inst& inst, const isa::Memory& shape, LaneMask lanes) {
  for (uint32_t row = 0; row < rows_of(shape); ++row) {
    uint32_t* const to = warp.regs.write(slot_of(inst, shape, kLoadFirst, row));
    for_each_lane(lanes, [&](int lane) { to[lane] = 0; });
  }
}

// "32 bytes past the end of the block's shared memory (64 bytes)"
std::string outside_of(std::string_view object, Address address, uint64_t bytes, uint64_t size) {
  if (address >= size)
    return fmt::format("{} bytes past the end of {} ({} bytes)", address - size, object, size);
  return fmt::format("{} bytes across the end of {} ({} bytes), {} of them past it", bytes, object, size,
                     address + bytes - size);
}

}  // namespace

bool Executor::run_memory(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  row.run(warp.regs, inst);
  lanes_in_.fill(0);
  is_late_ = false;
  const LaneMask exec = warp.regs.exec;
  bool ok = true;
  if (row.memory.space != Space::Generic) {
    lanes_in_[size_t(row.memory.space)] = exec;
    ok = access(warp, inst, row, row.memory.space, exec);
  } else {
    auto& address = warp.regs.access.address;
    for_each_lane(exec, [&](int lane) {
      const Space space = isa::space_of(address[size_t(lane)]);
      lanes_in_[size_t(space)] |= LaneMask{1} << lane;
      address[size_t(lane)] -= isa::window_of(space);
    });
    for (const Space space : {Space::Global, Space::Shared, Space::Local, Space::Const})
      ok = ok && access(warp, inst, row, space, lanes_in(space));
  }
  if (ok) ++warp.simt.pc;
  return ok;
}

bool Executor::access(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, Space space,
                      LaneMask lanes) {
  if (lanes == 0) return true;
  switch (space) {
    case Space::Global:
    case Space::Shared:
      return row.effect == Effect::Atomic ? modify(warp, inst, row, space, lanes)
                                          : move_data(warp, inst, row, space, lanes);
    case Space::Local:
      if (row.effect != Effect::Atomic) return access_local(warp, inst, row, lanes);
      return refuse(warp, inst, row, space, lanes,
                    "an atomic on local memory, which no other thread can reach");
    case Space::Const:
    case Space::Param:
      if (row.effect == Effect::Load) return load_constant(warp, inst, row, space, lanes);
      return refuse(warp, inst, row, space, lanes,
                    fmt::format("{} the constant bank, which can only be read", verb_of(row.effect)));
    case Space::Generic:
    case Space::None:
      break;
  }
  GLINT_PANIC("{}: no such space", row.name);
}

// An access that its space does not have: let pass, it does nothing and answers 0.
bool Executor::refuse(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, Space space,
                      LaneMask lanes, const std::string& why) {
  for (LaneMask rest = lanes; rest; rest &= rest - 1)
    if (!let_pass(warp, std::countr_zero(rest), FaultKind::OutOfBounds, [&] { return why; })) return false;
  if (isa::is_destination(row.operands.kind[0])) load_zeros(warp, inst, row.memory, lanes);
  lanes_in_[size_t(space)] = 0;
  return true;
}

// Where the lanes' data lies. Accesses are aligned to their size, as PTX asks. A lane whose access is let
// pass leaves `lanes` when it is outside. Choice: a misaligned one that is let pass goes to the multiple of
// its size below.
bool Executor::locate(WarpContext& warp, const isa::OpRow& row, Space space, LaneMask& lanes,
                      std::array<std::byte*, kLanes>& at) {
  const uint32_t bytes = row.memory.bytes * row.memory.count;
  std::vector<std::byte>& shared = warp.block->shared;
  for (LaneMask rest = lanes; rest; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    Address& address = warp.regs.access.address[size_t(lane)];
    std::byte* place = space == Space::Global             ? world_.memory->find(address, bytes)
                       : address + bytes <= shared.size() ? shared.data() + address
                                                          : nullptr;
    if (!place) [[unlikely]] {
      const bool is_global = space == Space::Global;
      const bool is_robust = is_global && world_.robust_buffers && !isa::unbound_place(address);
      if (!is_robust && !let_pass(warp, lane, FaultKind::OutOfBounds, [&] {
            return fmt::format("{} {} bytes at {}{:#x}: {}", verb_of(row.effect), bytes,
                               is_global ? "" : "shared address ", address,
                               is_global
                                   ? whereabouts(*world_.memory, address, bytes)
                                   : outside_of("the block's shared memory", address, bytes, shared.size()));
          }))
        return false;
      lanes &= ~(LaneMask{1} << lane);
      continue;
    }
    if (const auto beyond = uint32_t(address & (bytes - 1)); beyond) [[unlikely]] {
      if (!let_pass(warp, lane, FaultKind::Misaligned, [&] {
            return fmt::format(
                "{} {} bytes at {} address {:#x}, which is no multiple of {}{}", verb_of(row.effect), bytes,
                name_of(space), address, bytes,
                space == Space::Global ? ": " + whereabouts(*world_.memory, address, bytes) : "");
          }))
        return false;
      address -= beyond;
      place -= beyond;
    }
    at[size_t(lane)] = place;
  }
  lanes_in_[size_t(space)] = lanes;
  return true;
}

bool Executor::move_data(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, Space space,
                         LaneMask lanes) {
  std::array<std::byte*, kLanes> at;
  LaneMask inside = lanes;
  if (!locate(warp, row, space, inside, at)) return false;
  const bool seen = view_ && space == Space::Global;
  if (row.effect == Effect::Store) {
    changes_ += !seen;
    seen ? store_seen(warp, inst, row, inside, at) : store_rows(warp, inst, row.memory, inside, at);
    return true;
  }
  if (seen && view_->touched())
    load_seen(warp, inst, row, inside, at);
  else
    load_rows(warp, inst, row.memory, inside, at);
  if (inside != lanes) [[unlikely]]
    load_zeros(warp, inst, row.memory, lanes & ~inside);
  return true;
}

// Lanes take turns, the lowest first. Choice: PTX leaves their order open.
bool Executor::modify(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, Space space,
                      LaneMask lanes) {
  std::array<std::byte*, kLanes> at;
  LaneMask inside = lanes;
  if (!locate(warp, row, space, inside, at)) return false;
  const uint32_t bytes = row.memory.bytes;
  const bool returns = isa::is_destination(row.operands.kind[0]);
  const size_t first = returns ? 2 : 1;
  const bool has_second = row.operands.count > first + 1;
  if (returns && inside != lanes) [[unlikely]]
    load_zeros(warp, inst, row.memory, lanes & ~inside);
  if (view_ && space == Space::Global) return modify_seen(warp, inst, row, inside, at), true;
  for_each_lane(inside, [&](int lane) {
    uint64_t old = 0;
    std::memcpy(&old, at[size_t(lane)], bytes);
    const uint64_t b = read_operand(warp.regs, inst.operand[first], lane, bytes);
    const uint64_t c =
        has_second ? read_operand(warp.regs, inst.operand[first + 1], lane, bytes) : space == Space::Global;
    const uint64_t value = row.atomic(old, b, c);
    std::memcpy(at[size_t(lane)], &value, bytes);
    changes_ += value != old;
    if (!returns) return;
    uint32_t* const to = warp.regs.write(inst.operand[0]);
    to[lane] = uint32_t(old);
    if (bytes == 8) to[kLanes + lane] = uint32_t(old >> 32);
  });
  return true;
}

// The slow way of access_local: somebody is outside of the stack or misaligned. A frame that does not fit is
// an overflow, which nothing lets pass; lanes that are outside without it leave `lanes`.
bool Executor::check_local(WarpContext& warp, const isa::OpRow& row, LaneMask& lanes) {
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
        return fail(warp, lane,
                    what(fmt::format("{}, and it overflows: {} are in use and the shader's frame takes {}",
                                     size, stack_pointer, frame)));
      if (!let_pass(warp, lane, FaultKind::OutOfBounds, [&] { return what(size); })) return false;
      lanes &= ~(LaneMask{1} << lane);
    } else if (address % part != 0) {
      if (!let_pass(warp, lane, FaultKind::Misaligned,
                    [&] { return what(fmt::format(", which is no multiple of {}", part)); }))
        return false;
      address -= address % part;
    }
  }
  lanes_in_[size_t(Space::Local)] = lanes;
  return true;
}

// Local memory lies word by word, all lanes of a word together: a vector may start at any word, as spills do.
bool Executor::access_local(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, LaneMask lanes) {
  const isa::Memory& shape = row.memory;
  const uint32_t bytes = shape.bytes * shape.count, part = row_bytes(shape);
  const Address* const address = warp.regs.access.address.data();
  bool all_inside = true;
  for_each_lane(lanes, [&](int lane) {
    all_inside &= address[lane] % part == 0 && address[lane] + bytes <= world_.local_bytes;
  });
  if (!all_inside) [[unlikely]] {
    LaneMask inside = lanes;
    if (!check_local(warp, row, inside)) return false;
    if (row.effect == Effect::Load) load_zeros(warp, inst, shape, lanes & ~inside);
    lanes = inside;
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

bool Executor::load_constant(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, Space space,
                             LaneMask lanes) {
  const isa::Memory& shape = row.memory;
  const uint32_t bytes = shape.bytes * shape.count, part = row_bytes(shape);
  const uint64_t offset = space == Space::Param ? isa::kPushConstantOffset : 0;
  for (; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    Address address = warp.regs.access.address[size_t(lane)] + offset;
    const auto what = [&](const std::string& wrong) {
      return fmt::format("reads {} bytes at {} address {:#x}{}", bytes, name_of(space), address - offset,
                         wrong);
    };
    if (address + bytes > world_.constant_bank.size()) [[unlikely]] {
      if (!let_pass(warp, lane, FaultKind::OutOfBounds, [&] {
            return what(fmt::format(": the bank has {} bytes", world_.constant_bank.size() - offset));
          }))
        return false;
      load_zeros(warp, inst, shape, LaneMask{1} << lane);
      continue;
    }
    if (address & (bytes - 1)) [[unlikely]] {
      if (!let_pass(warp, lane, FaultKind::Misaligned,
                    [&] { return what(fmt::format(", which is no multiple of {}", bytes)); }))
        return false;
      address -= address & (bytes - 1);
    }
    const std::byte* const from = world_.constant_bank.data() + address;
    for (uint32_t r = 0; r < rows_of(shape); ++r) {
      uint32_t* const to = warp.regs.write(slot_of(inst, shape, kLoadFirst, r)) + lane;
      if (part == 4)
        std::memcpy(to, from + r * 4, 4);
      else
        *to = narrow(from + r * part, shape);
    }
  }
  return true;
}

}  // namespace glint::exec
