// Computes integer operations whose sources are constants.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "frontend/backend/slots.h"

namespace glint::frontend::ptx {

// Evaluates the ops of counters and addresses: sums, products, shifts by less than their width, extensions
// and moves.
class ConstantWords {
 public:
  // Returns what an instruction without a guard writes, if all of its sources are constants and its op is one
  // of these.
  std::optional<uint64_t> value_of(const VirtualInst& inst) const {
    uint64_t a = 0, b = 0;
    if (is_guarded(inst) || inst.operands.size() < 2 || inst.operands.size() > 3) return {};
    for (size_t k = 1; k < inst.operands.size(); ++k) {
      if (!is_constant(inst.operands[k])) return {};
      (k == 1 ? a : b) = inst.operands[k].constant;
    }
    const auto narrow = [](uint64_t x) { return uint64_t{uint32_t(x)}; };
    const auto extended = [](uint64_t x) { return uint64_t(int64_t{int32_t(uint32_t(x))}); };
    if (inst.op == ops_.mov_b32 || inst.op == ops_.low_word || inst.op == ops_.widen_u32) return narrow(a);
    if (inst.op == ops_.mov_b64) return a;
    if (inst.op == ops_.widen_s32) return extended(a);
    if (inst.op == ops_.add_u32 || inst.op == ops_.add_s32) return narrow(a + b);
    if (inst.op == ops_.add_u64 || inst.op == ops_.add_s64) return a + b;
    if (inst.op == ops_.mul_lo_u32 || inst.op == ops_.mul_lo_s32) return narrow(a * b);
    if (inst.op == ops_.mul_wide_u32) return narrow(a) * narrow(b);
    if (inst.op == ops_.mul_wide_s32) return extended(a) * extended(b);
    if (inst.op == ops_.shl_b32 && b < 32) return narrow(a << b);
    if (inst.op == ops_.shl_b64 && b < 64) return a << b;
    return {};
  }

 private:
  const Ops ops_;
};

}  // namespace glint::frontend::ptx
