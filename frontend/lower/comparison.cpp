// Lowers comparisons and logic, whose results are predicates.
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "frontend/lower/lowering.h"
#include "frontend/lower/typed.h"

namespace glint::frontend {
namespace {

void compare(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  const Part part = l.part_of(l.type_of(inst.operands[0]));
  const Operands a = l.value(inst.operands[0]), b = l.value(inst.operands[1]);
  Operands result;
  for (size_t i = 0; i < a.size(); ++i) result.push_back(typed(l.emit(), row.name32, part, {a[i], b[i]}));
  l.set(inst.result, std::move(result));
}

void test(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  const Part part = l.part_of(l.type_of(inst.operands[0]));
  Operands result;
  for (const Operand& a : Operands(l.value(inst.operands[0])))
    result.push_back(typed(l.emit(), row.name32, part, {a}));
  l.set(inst.result, std::move(result));
}

void logic(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  const Operands a = l.value(inst.operands[0]), b = l.value(inst.operands[1]);
  Operands result;
  for (size_t i = 0; i < a.size(); ++i) {
    const Operand both = l.emit().value(row.name32, {a[i], b[i]});
    result.push_back(inst.op == spv::Op::OpLogicalEqual ? l.emit().value("not.pred", {both}) : both);
  }
  l.set(inst.result, std::move(result));
}

// Lowers Any and All, which combine the parts of a bool vector.
void reduce(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  const Operands a = l.value(inst.operands[0]);
  Operand all = a[0];
  for (size_t i = 1; i < a.size(); ++i) all = l.emit().value(row.name32, {all, a[i]});
  l.set(inst.result, {all});
}

// Lowers OpSelect. The condition is one bool, or one bool for each component.
void select(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  if (l.module().type(inst.type).kind == Type::Kind::Pointer && !l.layout().is_address(inst.type))
    return l.unsupported("OpSelect of pointers");
  const Operands condition = l.value(inst.operands[0]), a = l.value(inst.operands[1]),
                 b = l.value(inst.operands[2]);
  const std::vector<Part> parts = l.layout().parts(inst.type);
  Operands result;
  for (size_t i = 0; i < a.size(); ++i) {
    const Operand& predicate = condition[condition.size() == 1 ? 0 : i];
    switch (class_of(parts[i])) {
      case RegisterClass::Predicate:
        result.push_back(l.emit().select_bool(predicate, a[i], b[i]));
        break;
      case RegisterClass::B64:
        result.push_back(l.emit().value("selp.b64", {a[i], b[i], predicate}));
        break;
      case RegisterClass::B32:
        result.push_back(l.emit().value("selp.b32", {a[i], b[i], predicate}));
        break;
    }
  }
  l.set(inst.result, std::move(result));
}

using enum spv::Op;
constexpr LoweringRow kComparisonRows[] = {
    {OpIEqual, compare, "setp.eq.u32"},
    {OpINotEqual, compare, "setp.ne.u32"},
    {OpULessThan, compare, "setp.lt.u32"},
    {OpULessThanEqual, compare, "setp.le.u32"},
    {OpUGreaterThan, compare, "setp.gt.u32"},
    {OpUGreaterThanEqual, compare, "setp.ge.u32"},
    {OpSLessThan, compare, "setp.lt.s32"},
    {OpSLessThanEqual, compare, "setp.le.s32"},
    {OpSGreaterThan, compare, "setp.gt.s32"},
    {OpSGreaterThanEqual, compare, "setp.ge.s32"},
    {OpFOrdEqual, compare, "setp.eq.f32"},
    {OpFOrdNotEqual, compare, "setp.ne.f32"},
    {OpFOrdLessThan, compare, "setp.lt.f32"},
    {OpFOrdLessThanEqual, compare, "setp.le.f32"},
    {OpFOrdGreaterThan, compare, "setp.gt.f32"},
    {OpFOrdGreaterThanEqual, compare, "setp.ge.f32"},
    {OpFUnordEqual, compare, "setp.equ.f32"},
    {OpFUnordNotEqual, compare, "setp.neu.f32"},
    {OpFUnordLessThan, compare, "setp.ltu.f32"},
    {OpFUnordLessThanEqual, compare, "setp.leu.f32"},
    {OpFUnordGreaterThan, compare, "setp.gtu.f32"},
    {OpFUnordGreaterThanEqual, compare, "setp.geu.f32"},
    {OpIsNan, test, "testp.notanumber.f32"},
    {OpIsInf, test, "testp.infinite.f32"},
    {OpLogicalAnd, logic, "and.pred"},
    {OpLogicalOr, logic, "or.pred"},
    {OpLogicalEqual, logic, "xor.pred"},
    {OpLogicalNotEqual, logic, "xor.pred"},
    {OpLogicalNot, test, "not.pred"},
    {OpAny, reduce, "or.pred"},
    {OpAll, reduce, "and.pred"},
    {OpSelect, select, ""},
};

}  // namespace

std::span<const LoweringRow> comparison_rows() {
  return kComparisonRows;
}

}  // namespace glint::frontend
