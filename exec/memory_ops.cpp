// Moves data between registers and simulated memory: loads, stores and atomics, with a check of each access.
// SPDX-License-Identifier: Apache-2.0
#include "exec/memory_ops.h"

#include <bit>
#include <cstddef>
#include <cstring>
#include <fmt/format.h>
#include <vector>

#include "base/check.h"
#include "exec/access_words.h"
#include "isa/atomic.h"
#include "isa/descriptors.h"
#include "isa/generic_address.h"

namespace glint::exec {

using isa::Effect;
using isa::Space;

namespace {

// Stores lane by lane, so that where two lanes write one place the higher lane's value stays. Choice: PTX
// leaves it open.
void store_rows(const WarpContext& warp, const isa::Inst& inst, const isa::Memory& shape, LaneMask lanes,
                const LanePlaces& to) {
  const uint32_t bytes = row_bytes(shape);
  for_each_lane(lanes, [&](int lane) {
    for (uint32_t row = 0; row < rows_of(shape); ++row)
      std::memcpy(to[size_t(lane)] + row * bytes,
                  warp.regs.read(slot_of(inst, shape, kStoreFirst, row)) + lane, bytes);
  });
}

// Says where an access lies, such as "32 bytes past the end of the block's shared memory (64 bytes)".
std::string outside_of(std::string_view object, Address address, uint64_t bytes, uint64_t size) {
  if (address >= size)
    return fmt::format("{} bytes past the end of {} ({} bytes)", address - size, object, size);
  return fmt::format("{} bytes across the end of {} ({} bytes), {} of them past it", bytes, object, size,
                     address + bytes - size);
}

}  // namespace

bool MemoryOps::run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  row.run(warp.regs, inst, row);
  lanes_in_.fill(0);
  seen_.begin_access();
  const LaneMask exec = warp.regs.exec;
  bool ok = true;
  if (row.effect == Effect::Copy) {
    ok = copy(warp, inst, row, exec);
  } else if (row.memory.matrices > 0) {
    ok = move_matrices(warp, inst, row, exec);
  } else if (row.memory.space != Space::Generic) {
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

bool MemoryOps::access(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, Space space,
                       LaneMask lanes) {
  if (lanes == 0) return true;
  switch (space) {
    case Space::Global:
    case Space::Shared:
      if (row.effect == Effect::Mbarrier) return run_mbarrier(warp, inst, row, lanes);
      return row.effect == Effect::Atomic ? modify(warp, inst, row, space, lanes)
                                          : move_data(warp, inst, row, space, lanes);
    case Space::Local:
      if (row.effect != Effect::Atomic)
        return local_.access(warp, inst, row, lanes_in_[size_t(Space::Local)]);
      return refuse(warp, inst, row, space, lanes,
                    "an atomic on local memory, which no other thread can reach");
    case Space::Const:
    case Space::Param:
      if (row.effect == Effect::Load) return constants_.load(warp, inst, row, space, lanes);
      return refuse(warp, inst, row, space, lanes,
                    fmt::format("{} the constant bank, which can only be read", verb_of(row.effect)));
    case Space::Generic:
    case Space::None:
      break;
  }
  GLINT_PANIC("{}: no such space", row.name);
}

// Refuses an access of a kind that its space does not have. When the access is let pass, it does nothing and
// answers 0.
bool MemoryOps::refuse(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, Space space,
                       LaneMask lanes, const std::string& why) {
  for (LaneMask rest = lanes; rest; rest &= rest - 1)
    if (!faults_.let_pass(warp, std::countr_zero(rest), FaultKind::OutOfBounds, [&] { return why; }))
      return false;
  if (isa::is_destination(row.operands.kind[0])) load_zeros(warp, inst, row.memory, lanes);
  lanes_in_[size_t(space)] = 0;
  return true;
}

// Finds where the lanes' data lies. Accesses are aligned to their size, as PTX requires. A lane whose access
// is let pass leaves `lanes` when it is outside. Choice: a misaligned access that is let pass goes to the
// multiple of its size below.
bool MemoryOps::locate(WarpContext& warp, const isa::OpRow& row, Space space, LaneMask& lanes,
                       LanePlaces& at) {
  const uint32_t bytes = row.memory.bytes * row.memory.count;
  std::vector<std::byte>& shared = warp.block->shared;
  for (LaneMask rest = lanes; rest; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    Address& address = warp.regs.access.address[size_t(lane)];
    std::byte* place = space == Space::Global             ? world_.memory->find(address, bytes)
                       : address + bytes <= shared.size() ? shared.data() + address
                                                          : nullptr;
    if (!place) [[unlikely]] {
      if (!pass_outside(warp, lane, {space, row.effect, bytes}, address)) return false;
      lanes &= ~(LaneMask{1} << lane);
      continue;
    }
    if (const auto beyond = uint32_t(address & (bytes - 1)); beyond) [[unlikely]] {
      if (!pass_misaligned(warp, lane, {space, row.effect, bytes}, address)) return false;
      address -= beyond;
      place -= beyond;
    }
    at[size_t(lane)] = place;
  }
  if (space == Space::Global && seen_.is_apart()) [[unlikely]]
    for_each_lane(lanes, [&](int lane) {
      at[size_t(lane)] =
          seen_.place(warp.regs.access.address[size_t(lane)], at[size_t(lane)], bytes, row.effect);
    });
  lanes_in_[size_t(space)] = lanes;
  return true;
}

// Returns whether an access outside of its space is let pass.
bool MemoryOps::pass_outside(const WarpContext& warp, int lane, const Reach& reach, Address address) {
  const bool is_global = reach.space == Space::Global;
  if (is_global && world_.robust_buffers && !isa::unbound_place(address)) return true;
  if (is_global && isa::is_null_address(address)) return true;
  return faults_.let_pass(warp, lane, FaultKind::OutOfBounds, [&] {
    return fmt::format(
        "{} {} bytes at {}{:#x}: {}", verb_of(reach.effect), reach.bytes, is_global ? "" : "shared address ",
        address,
        is_global ? whereabouts(*world_.memory, address, reach.bytes)
                  : outside_of("the block's shared memory", address, reach.bytes, warp.block->shared.size()));
  });
}

bool MemoryOps::pass_misaligned(const WarpContext& warp, int lane, const Reach& reach, Address address) {
  return faults_.let_pass(warp, lane, FaultKind::Misaligned, [&] {
    return fmt::format(
        "{} {} bytes at {} address {:#x}, which is not a multiple of {}{}", verb_of(reach.effect),
        reach.bytes, name_of(reach.space), address, reach.bytes,
        reach.space == Space::Global ? ": " + whereabouts(*world_.memory, address, reach.bytes) : "");
  });
}

bool MemoryOps::move_data(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, Space space,
                          LaneMask lanes) {
  LanePlaces at;
  LaneMask inside = lanes;
  if (!locate(warp, row, space, inside, at)) return false;
  move_rows(warp, inst, row.effect, row.memory, space, inside, at);
  if (inside == lanes) [[likely]]
    return true;
  if (row.effect == Effect::Load) load_zeros(warp, inst, row.memory, lanes & ~inside);
  if (space == Space::Global && world_.robust_buffers) move_beginnings(warp, inst, row, lanes & ~inside);
  return true;
}

void MemoryOps::move_rows(WarpContext& warp, const isa::Inst& inst, Effect effect, const isa::Memory& shape,
                          Space space, LaneMask lanes, const LanePlaces& at) {
  const bool seen = seen_.is_used() && space == Space::Global;
  if (effect == Effect::Store) {
    ++warp.effects;
    changes_ += !seen;
    seen ? seen_.store(warp, inst, shape, lanes, at) : store_rows(warp, inst, shape, lanes, at);
  } else if (seen && seen_.view().touched()) {
    seen_.load(warp, inst, shape, lanes, at);
  } else {
    load_rows(warp, inst, shape, lanes, at);
  }
}

// Moves the first parts of vectors that reach across the end of a buffer. Choice: Vulkan lets each 32 bits of
// a vector be checked on their own, or the vector as a whole (robustBufferAccess in
// VkPhysicalDeviceFeatures). Model: these parts cost no access.
void MemoryOps::move_beginnings(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row,
                                LaneMask lanes) {
  LanePlaces at{};
  for_each_lane(lanes, [&](int lane) {
    const Address address = warp.regs.access.address[size_t(lane)];
    if (address % (row.memory.bytes * row.memory.count)) return;
    isa::Memory shape = row.memory;
    while (--shape.count > 0) {
      const uint32_t bytes = shape.bytes * shape.count;
      std::byte* const place = world_.memory->find(address, bytes);
      if (!place) continue;
      at[size_t(lane)] = seen_.place(address, place, bytes, row.effect);
      return move_rows(warp, inst, row.effect, shape, Space::Global, LaneMask{1} << lane, at);
    }
  });
}

// Returns whether lanes that go round in a loop have done something with the atomic (WarpContext::effects):
// they have neither asked for a lock nor looked at a word by adding 0 to it.
bool MemoryOps::has_effect(const WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row,
                           LaneMask lanes) {
  if (!isa::gives_old_value(row)) return true;
  if (isa::exchanges(row)) return false;
  bool any = false;
  for_each_lane(
      lanes, [&](int lane) { any |= read_operand(warp.regs, inst.operand[2], lane, row.memory.bytes) != 0; });
  return any;
}

// Runs an atomic. Lanes take turns, the lowest first. Choice: PTX leaves their order open.
bool MemoryOps::modify(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, Space space,
                       LaneMask lanes) {
  LanePlaces at;
  LaneMask inside = lanes;
  if (!locate(warp, row, space, inside, at)) return false;
  const uint32_t bytes = row.memory.bytes;
  const bool returns = isa::is_destination(row.operands.kind[0]);
  const size_t first = returns ? 2 : 1;
  const bool has_second = row.operands.count > first + 1;
  if (returns && inside != lanes) [[unlikely]]
    load_zeros(warp, inst, row.memory, lanes & ~inside);
  warp.effects += has_effect(warp, inst, row, inside);
  if (seen_.is_used() && space == Space::Global) return seen_.modify(warp, inst, row, inside, at), true;
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

}  // namespace glint::exec
