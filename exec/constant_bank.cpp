// Loads from the constant bank.
// SPDX-License-Identifier: Apache-2.0
#include "exec/constant_bank.h"

#include <bit>
#include <cstring>
#include <fmt/format.h>
#include <string>

#include "exec/access_rows.h"
#include "exec/access_words.h"

namespace glint::exec {

using isa::Space;

bool ConstantBank::load(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, Space space,
                        LaneMask lanes) {
  const isa::Memory& shape = row.memory;
  const uint32_t bytes = shape.bytes * shape.count, part = row_bytes(shape);
  const uint64_t offset = space == Space::Param ? isa::kPushConstantOffset : 0;
  if (is_uniform(warp.regs.access, lanes)) {
    const Address common = warp.regs.access.address[size_t(std::countr_zero(lanes))] + offset;
    if (common + bytes <= world_.constant_bank.size() && (common & (bytes - 1)) == 0) [[likely]] {
      for (uint32_t r = 0; r < rows_of(shape); ++r) {
        const uint32_t value = part_of(world_.constant_bank.data() + common + r * part, shape);
        uint32_t* const to = warp.regs.write(slot_of(inst, shape, kLoadFirst, r));
        for_each_lane(lanes, [&](int lane) { to[lane] = value; });
      }
      return true;
    }
  }
  for (; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    Address address = warp.regs.access.address[size_t(lane)] + offset;
    const auto what = [&](const std::string& wrong) {
      return fmt::format("reads {} bytes at {} address {:#x}{}", bytes, name_of(space), address - offset,
                         wrong);
    };
    if (address + bytes > world_.constant_bank.size()) [[unlikely]] {
      if (!faults_.let_pass(warp, lane, FaultKind::OutOfBounds, [&] {
            return what(fmt::format(": the bank has {} bytes", world_.constant_bank.size() - offset));
          }))
        return false;
      load_zeros(warp, inst, shape, LaneMask{1} << lane);
      continue;
    }
    if (address & (bytes - 1)) [[unlikely]] {
      if (!faults_.let_pass(warp, lane, FaultKind::Misaligned,
                            [&] { return what(fmt::format(", which is not a multiple of {}", bytes)); }))
        return false;
      address -= address & (bytes - 1);
    }
    const std::byte* const from = world_.constant_bank.data() + address;
    for (uint32_t r = 0; r < rows_of(shape); ++r) {
      warp.regs.write(slot_of(inst, shape, kLoadFirst, r))[lane] = part_of(from + r * part, shape);
    }
  }
  return true;
}

}  // namespace glint::exec
