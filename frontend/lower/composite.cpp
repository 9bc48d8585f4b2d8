// Lowers ops that pick and join parts of vectors, structs, arrays and matrices. They emit no code, except for
// dynamic component indices.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <utility>

#include "frontend/lower/lowering.h"

namespace glint::frontend {
namespace {

// Returns the number of the first part, and the type, of what a list of literal indices reaches from `type`.
std::pair<uint32_t, Id> walk(ModuleLowering& l, Id type, std::span<const uint32_t> indices) {
  uint32_t first = 0;
  for (uint32_t index : indices) {
    first += l.layout().first_part(type, index);
    type = l.layout().member_type(type, index);
  }
  return {first, type};
}

void construct(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Operands result;
  for (Id member : inst.operands) {
    const Operands parts = l.value(member);
    result.insert(result.end(), parts.begin(), parts.end());
  }
  l.set(inst.result, std::move(result));
}

void extract(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Operands from = l.value(inst.operands[0]);
  const auto [first, type] = walk(l, l.type_of(inst.operands[0]), std::span(inst.operands).subspan(1));
  const uint32_t count = l.layout().num_parts(type);
  l.set(inst.result, Operands(from.begin() + first, from.begin() + first + count));
}

void insert(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Operands part = l.value(inst.operands[0]);
  Operands whole = l.value(inst.operands[1]);
  const uint32_t first = walk(l, inst.type, std::span(inst.operands).subspan(2)).first;
  for (size_t i = 0; i < part.size(); ++i) whole[first + i] = part[i];
  l.set(inst.result, std::move(whole));
}

void shuffle_vectors(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Operands both = l.value(inst.operands[0]);
  const Operands second = l.value(inst.operands[1]);
  both.insert(both.end(), second.begin(), second.end());
  Operands result;
  for (size_t i = 2; i < inst.operands.size(); ++i)  // 0xffffffff: no source, so the component is undefined
    result.push_back(inst.operands[i] < both.size() ? both[inst.operands[i]] : Operand::value(0));
  l.set(inst.result, std::move(result));
}

void copy(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  if (l.module().type(inst.type).kind == Type::Kind::Pointer)
    l.set_pointer(inst.result, l.pointer(inst.operands[0]));
  else
    l.set(inst.result, Operands(l.value(inst.operands[0])));
}

void undefined(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  // Choice: an undefined value is 0.
  l.set(inst.result, Operands(l.layout().num_parts(inst.type), Operand::value(0)));
}

Operand choose(ModuleLowering& l, Part part, const Operand& predicate, const Operand& a, const Operand& b) {
  if (part == Part::Bool) return l.emit().select_bool(predicate, a, b);
  return l.emit().value(class_of(part) == RegisterClass::B64 ? "selp.b64" : "selp.b32", {a, b, predicate});
}

// Lowers to a chain of selects. An index out of range gives the first component.
void extract_dynamic(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Operands from = l.value(inst.operands[0]);
  const Operand index = l.scalar(inst.operands[1]);
  const Part part = l.layout().parts(inst.type)[0];
  Operand result = from[0];
  for (size_t i = 1; i < from.size(); ++i)
    result = choose(l, part, l.emit().value("setp.eq.u32", {index, Operand::value(i)}), from[i], result);
  l.set(inst.result, {result});
}

void insert_dynamic(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Operands whole = l.value(inst.operands[0]);
  const Operand part = l.scalar(inst.operands[1]), index = l.scalar(inst.operands[2]);
  const Part kind = l.layout().parts(inst.type)[0];
  for (size_t i = 0; i < whole.size(); ++i)
    whole[i] = choose(l, kind, l.emit().value("setp.eq.u32", {index, Operand::value(i)}), part, whole[i]);
  l.set(inst.result, std::move(whole));
}

using enum spv::Op;
constexpr LoweringRow kCompositeRows[] = {
    {OpCompositeConstruct, construct, ""},
    {OpCompositeExtract, extract, ""},
    {OpCompositeInsert, insert, ""},
    {OpVectorShuffle, shuffle_vectors, ""},
    {OpVectorExtractDynamic, extract_dynamic, ""},
    {OpVectorInsertDynamic, insert_dynamic, ""},
    {OpCopyObject, copy, ""},
    {OpCopyLogical, copy, ""},
    {OpUndef, undefined, ""},
};

}  // namespace

std::span<const LoweringRow> composite_rows() {
  return kCompositeRows;
}

}  // namespace glint::frontend
