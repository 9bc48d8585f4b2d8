// Loads from, stores to and modifies global memory that is seen through a view.
// SPDX-License-Identifier: Apache-2.0
#include "exec/seen_memory.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace glint::exec {

void SeenMemory::load(WarpContext& warp, const isa::Inst& inst, const isa::Memory& shape, LaneMask lanes,
                      const LanePlaces& at) {
  const uint32_t bytes = shape.bytes * shape.count, part = row_bytes(shape);
  bool is_late = false;
  for_each_lane(lanes, [&](int lane) { is_late |= view_->waits(at[size_t(lane)], bytes); });
  is_late_ |= is_late;
  if (!is_late) {
    std::array<std::array<std::byte, MemoryView::kWidest>, kLanes> scratch;
    std::array<const std::byte*, kLanes> from;
    for_each_lane(lanes, [&](int lane) {
      from[size_t(lane)] = view_->read(at[size_t(lane)], bytes, scratch[size_t(lane)]);
    });
    return load_rows(warp, inst, shape, lanes, from);
  }
  for (uint32_t r = 0; r < rows_of(shape); ++r) {
    uint32_t* const to = warp.regs.write(slot_of(inst, shape, kLoadFirst, r));
    for_each_lane(lanes, [&](int lane) {
      view_->load(MemoryView::Load{at[size_t(lane)] + r * part, uint8_t(part), shape.sign_extend, to + lane});
    });
  }
}

// Stores lanes in the same order as without a view.
void SeenMemory::store(const WarpContext& warp, const isa::Inst& inst, const isa::Memory& shape,
                       LaneMask lanes, const LanePlaces& at) {
  const uint32_t part = row_bytes(shape);
  std::array<std::byte, MemoryView::kWidest> data;
  for_each_lane(lanes, [&](int lane) {
    for (uint32_t r = 0; r < rows_of(shape); ++r)
      std::memcpy(data.data() + r * part, warp.regs.read(slot_of(inst, shape, kStoreFirst, r)) + lane, part);
    view_->store(at[size_t(lane)], data.data(), rows_of(shape) * part);
  });
}

void SeenMemory::modify(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, LaneMask lanes,
                        const LanePlaces& at) {
  const uint32_t bytes = row.memory.bytes;
  is_late_ = isa::is_destination(row.operands.kind[0]);
  const size_t first = is_late_ ? 2 : 1;
  const bool has_second = row.operands.count > first + 1;
  for_each_lane(lanes, [&](int lane) {
    const uint64_t b = read_operand(warp.regs, inst.operand[first], lane, bytes);
    const uint64_t c = has_second ? read_operand(warp.regs, inst.operand[first + 1], lane, bytes)
                                  : 1;  // 1: in global memory
    view_->modify({at[size_t(lane)], row.atomic, b, c, uint8_t(bytes),
                   is_late_ ? warp.regs.write(inst.operand[0]) + lane : nullptr});
  });
}

}  // namespace glint::exec
