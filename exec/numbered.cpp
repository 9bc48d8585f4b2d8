// Finds the number by which the lanes of a warp name an object.
// SPDX-License-Identifier: Apache-2.0
#include "exec/numbered.h"

#include <bit>
#include <fmt/format.h>

namespace glint::exec {

std::optional<uint32_t> shared_number(FaultGate& faults, const WarpContext& warp, isa::Slot operand,
                                      std::string_view what) {
  const uint32_t* number = warp.regs.read(operand);
  const int first = std::countr_zero(warp.regs.exec);
  bool same = true;
  for_each_lane(warp.regs.exec, [&](int lane) { same &= number[lane] == number[first]; });
  if (same && number[first] < kMaxNumbered) return number[first];
  faults.fail(warp, first,
              same ? fmt::format("uses {} {}, and a shader has at most {}", what, number[first], kMaxNumbered)
                   : fmt::format("the lanes of a warp use more than one {} at once", what));
  return std::nullopt;
}

}  // namespace glint::exec
