// Lowers dot products of integers: products at full width are summed in 64 bits, then cut or saturated.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "frontend/lower/lowering.h"
#include "frontend/lower/typed.h"

namespace glint::frontend {
namespace {

using enum spv::Op;

struct Signs {
  bool a, b, result;
};
Signs signs_of(spv::Op op) {
  switch (op) {
    case OpSDotKHR:
    case OpSDotAccSatKHR:
      return {true, true, true};
    case OpSUDotKHR:
    case OpSUDotAccSatKHR:
      return {true, false, true};
    default:
      return {false, false, false};
  }
}

Operand widened_64(Emitter& e, Part part, const Operand& x, bool is_signed) {
  if (bytes_of(part) == 8) return x;
  return e.value(is_signed ? "cvt.s64.s32" : "cvt.u64.u32", {widened(e, part, x, is_signed)});
}

// Returns the components as 64-bit integers. A single 32-bit integer holds four components of 8 bits.
Operands components(ModuleLowering& l, Id id, bool is_signed) {
  Emitter& e = l.emit();
  const Operands parts = l.value(id);
  const Part part = l.part_of(l.type_of(id));
  Operands result;
  if (parts.size() == 1)
    for (uint32_t i = 0; i < 4; ++i) {
      const Operand byte =
          e.value(is_signed ? "bfe.s32" : "bfe.u32", {parts[0], Operand::value(8 * i), Operand::value(8)});
      result.push_back(widened_64(e, Part::Int32, byte, is_signed));
    }
  else
    for (const Operand& x : parts) result.push_back(widened_64(e, part, x, is_signed));
  return result;
}

// Choice: the sum wraps at 64 bits before saturation. Sums of products of up to 32 bits cannot reach that.
Operand saturated(Emitter& e, Part part, const Operand& sum, bool is_signed) {
  const uint32_t bits = 8 * bytes_of(part);
  if (bits == 64) return sum;
  if (!is_signed) return e.value("min.u64", {sum, Operand::value((uint64_t{1} << bits) - 1)});
  const uint64_t most = (uint64_t{1} << (bits - 1)) - 1;
  return e.value("max.s64", {e.value("min.s64", {sum, Operand::value(most)}), Operand::value(~most)});
}

void dot(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Emitter& e = l.emit();
  const bool accumulates =
      inst.op == OpSDotAccSatKHR || inst.op == OpUDotAccSatKHR || inst.op == OpSUDotAccSatKHR;
  const Signs signs = signs_of(inst.op);
  const Part part = l.part_of(inst.type);
  const Operands a = components(l, inst.operands[0], signs.a), b = components(l, inst.operands[1], signs.b);
  Operand sum = e.value("mul.lo.u64", {a[0], b[0]});
  for (size_t i = 1; i < a.size(); ++i) sum = e.value("add.u64", {sum, e.value("mul.lo.u64", {a[i], b[i]})});
  if (accumulates) {
    sum = e.value("add.u64", {sum, widened_64(e, part, l.scalar(inst.operands[2]), signs.result)});
    sum = saturated(e, part, sum, signs.result);
  }
  l.set(inst.result, {bytes_of(part) == 8 ? sum : narrowed(e, part, e.value("cvt.u32.u64", {sum}))});
}

constexpr LoweringRow kDotRows[] = {
    {OpSDotKHR, dot, ""},       {OpUDotKHR, dot, ""},       {OpSUDotKHR, dot, ""},
    {OpSDotAccSatKHR, dot, ""}, {OpUDotAccSatKHR, dot, ""}, {OpSUDotAccSatKHR, dot, ""},
};

}  // namespace

std::span<const LoweringRow> dot_rows() {
  return kDotRows;
}

}  // namespace glint::frontend
