// Copies from global to shared memory for cp.async.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <fmt/format.h>
#include <vector>

#include "exec/memory_ops.h"

namespace glint::exec {

using isa::Effect;
using isa::Space;

// Runs a cp.async. Model: the data is in shared memory at once, and only its time passes later
// (core/async_copies.h). A program that waits before it reads cannot tell; one that does not wait may see on
// hardware what was there before.
bool MemoryOps::copy(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, LaneMask lanes) {
  const uint32_t bytes = row.memory.bytes * row.memory.count;
  const uint32_t* const to = warp.regs.read(inst.operand[0]);
  const uint32_t* const sizes = warp.regs.read(inst.operand[2]);
  LaneMask from_global = 0, into_shared = 0;
  for (LaneMask rest = lanes; rest; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    const uint32_t size = sizes[lane];
    if (size > bytes)
      return faults_.fail(
          warp, lane,
          fmt::format("copies {} bytes of global memory to {} bytes of shared memory", size, bytes));
    copied_to_.address[size_t(lane)] = to[lane];
    bool ok = true;
    std::byte* const target = copy_target(warp, lane, bytes, ok);
    const std::byte* const source =
        ok && target ? copy_source(warp, lane, {Space::Global, Effect::Load, bytes}, size, ok) : nullptr;
    if (!ok) return false;
    if (!target) continue;
    into_shared |= LaneMask{1} << lane;
    from_global |= LaneMask{source != nullptr} << lane;
    copy_lane(target, source, bytes, source ? size : 0);
  }
  lanes_in_[size_t(Space::Global)] = from_global;
  lanes_in_[size_t(Space::Shared)] = into_shared;
  changes_ += into_shared != 0;
  return true;
}

// Returns where a lane's copy goes in the block's shared memory, or null when the copy is let pass and goes
// nowhere.
std::byte* MemoryOps::copy_target(const WarpContext& warp, int lane, uint32_t bytes, bool& ok) {
  const Reach reach{Space::Shared, Effect::Store, bytes};
  Address& address = copied_to_.address[size_t(lane)];
  std::vector<std::byte>& shared = warp.block->shared;
  if (address + bytes > shared.size()) {
    ok = pass_outside(warp, lane, reach, address);
    return nullptr;
  }
  if (address % bytes != 0) ok = pass_misaligned(warp, lane, reach, address);
  address -= address % bytes;
  return shared.data() + address;
}

// Returns where the first `size` bytes of a lane's copy come from, or null when there are none. Bytes behind
// them may lie outside of all buffers. The alignment is that of the whole copy all the same (PTX ISA).
const std::byte* MemoryOps::copy_source(WarpContext& warp, int lane, const Reach& reach, uint32_t size,
                                        bool& ok) {
  if (size == 0) return nullptr;
  Address& address = warp.regs.access.address[size_t(lane)];
  if (address % reach.bytes != 0) {
    ok = pass_misaligned(warp, lane, reach, address);
    address -= address % reach.bytes;
  }
  std::byte* const place = world_.memory->find(address, size);
  if (!place) {
    ok = ok && pass_outside(warp, lane, {reach.space, reach.effect, size}, address);
    return nullptr;
  }
  return seen_.place(address, place, size, Effect::Load);
}

// Copies `size` bytes and fills up with zeros. Bytes that an atomic of this turn changes come with the others
// of the turn (exec/memory_view.h).
void MemoryOps::copy_lane(std::byte* to, const std::byte* from, uint32_t bytes, uint32_t size) {
  std::memset(to + size, 0, bytes - size);
  if (size == 0) return;
  if (!seen_.is_used() || !seen_.view().touched()) {
    std::memcpy(to, from, size);
  } else if (!seen_.view().waits(from, size)) {
    std::array<std::byte, MemoryView::kWidest> scratch;
    std::memcpy(to, seen_.view().read(from, size, scratch), size);
  } else {
    seen_.be_late(true);
    for (uint32_t first = 0; first < size; first += 4)
      seen_.view().load(MemoryView::Load{from + first, uint8_t(std::min(size - first, 4u)), false,
                                         reinterpret_cast<uint32_t*>(to + first)});
  }
}

}  // namespace glint::exec
