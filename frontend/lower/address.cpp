// Lowers comparisons and differences of pointers as addresses. It also lowers hints to optimisers, which
// compute nothing.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "frontend/lower/lowering.h"

namespace glint::frontend {
namespace {

// Returns the address of a pointer, which need not be a value. Only modules with physical addresses compare
// pointers to the memory of one lane.
Operand address(ModuleLowering& l, Id id) {
  if (l.layout().is_address(l.type_of(id))) return l.scalar(id);
  if (const auto constant = l.module().constants.find(id); constant != l.module().constants.end())
    return Operand::value(constant->second.op == spv::Op::OpConstantNull ? kNullAddress : 0);
  const Pointer p = l.pointer(id);
  if (p.space == PointerSpace::Local)
    return l.emit().value("add.u32", {p.base, Operand::value(uint32_t(p.displacement))});
  l.unsupported("the address of this kind of variable");
  return Operand::value(0);
}

bool has_long_address(ModuleLowering& l, Id pointer) {
  return l.layout().is_address(pointer) && l.part_of(pointer) == Part::Uint64;
}

void compare_pointers(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  const Operand a = address(l, inst.operands[0]), b = address(l, inst.operands[1]);
  const bool is_64 = has_long_address(l, l.type_of(inst.operands[0]));
  l.set(inst.result, {l.emit().value(is_64 ? row.name64 : row.name32, {a, b})});
}

// Subtracts two pointers. The result counts elements, so the division leaves no remainder.
void difference(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Emitter& e = l.emit();
  const Id pointer = l.type_of(inst.operands[0]);
  const Type& type = l.module().type(pointer);
  const uint32_t stride = type.array_stride != 0 ? type.array_stride : l.layout().size(type.element);
  const Operand a = address(l, inst.operands[0]), b = address(l, inst.operands[1]);
  const bool is_64 = has_long_address(l, pointer),
             to_64 = l.part_of(inst.type) == Part::Uint64 || l.part_of(inst.type) == Part::Int64;
  Operand count = is_64 ? e.value("div.s64", {e.value("sub.u64", {a, b}), Operand::value(stride)})
                        : e.value("div.s32", {e.value("sub.u32", {a, b}), Operand::value(stride)});
  if (is_64 && !to_64) count = e.value("cvt.u32.u64", {count});
  if (!is_64 && to_64) count = e.value("cvt.s64.s32", {count});
  l.set(inst.result, {count});
}

void expect(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  l.set(inst.result, Operands(l.value(inst.operands[0])));
}
void nothing(ModuleLowering&, const Instruction&, const LoweringRow&) {
}

using enum spv::Op;
constexpr LoweringRow kAddressRows[] = {
    {OpPtrEqual, compare_pointers, "setp.eq.u32", "setp.eq.u64"},
    {OpPtrNotEqual, compare_pointers, "setp.ne.u32", "setp.ne.u64"},
    {OpPtrDiff, difference, ""},
    {OpExpectKHR, expect, ""},
    {OpAssumeTrueKHR, nothing, ""},
};

}  // namespace

std::span<const LoweringRow> address_rows() {
  return kAddressRows;
}

}  // namespace glint::frontend
