// Visits the operands of a virtual instruction one register at a time: those that it defines and those that
// it uses. It also names the ops that the backend itself emits or knows.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "frontend/virtual_program.h"

namespace glint::frontend {

// Holds the row indices of the ops that the backend names.
struct Ops {
  uint16_t mov_b32 = isa::op_index("mov.b32"), mov_b64 = isa::op_index("mov.b64");
  uint16_t mov_pred = isa::op_index("mov.pred"), not_pred = isa::op_index("not.pred");
  uint16_t pack = isa::op_index("pack.b64"), unpack = isa::op_index("unpack.b64");
  uint16_t low_word = isa::op_index("cvt.u32.u64"), widen_u32 = isa::op_index("cvt.u64.u32");
  uint16_t widen_s32 = isa::op_index("cvt.s64.s32");
  uint16_t selp_b32 = isa::op_index("selp.b32"), selp_b64 = isa::op_index("selp.b64");
  uint16_t setp_ne = isa::op_index("setp.ne.u32");
  uint16_t add_u32 = isa::op_index("add.u32"), sub_u32 = isa::op_index("sub.u32");
  uint16_t add_s32 = isa::op_index("add.s32");
  uint16_t add_u64 = isa::op_index("add.u64"), add_s64 = isa::op_index("add.s64");
  uint16_t mul_lo_u32 = isa::op_index("mul.lo.u32"), mul_lo_s32 = isa::op_index("mul.lo.s32");
  uint16_t mad_lo_u32 = isa::op_index("mad.lo.u32");
  uint16_t mul_wide_u32 = isa::op_index("mul.wide.u32"), mad_wide_u32 = isa::op_index("mad.wide.u32");
  uint16_t mul_wide_s32 = isa::op_index("mul.wide.s32"), mad_wide_s32 = isa::op_index("mad.wide.s32");
  uint16_t shl_b32 = isa::op_index("shl.b32"), shl_b64 = isa::op_index("shl.b64");
  uint16_t bra = isa::op_index("bra"), ssy = isa::op_index("ssy"), join = isa::op_index("join");
  uint16_t load_b32 = isa::op_index("ld.local.b32"), load_b64 = isa::op_index("ld.local.b64");
  uint16_t load_v2 = isa::op_index("ld.local.v2.b32"), load_v4 = isa::op_index("ld.local.v4.b32");
  uint16_t store_b32 = isa::op_index("st.local.b32"), store_b64 = isa::op_index("st.local.b64");
  uint16_t store_v2 = isa::op_index("st.local.v2.b32"), store_v4 = isa::op_index("st.local.v4.b32");

  bool is_move(uint16_t op) const { return op == mov_b32 || op == mov_b64 || op == mov_pred; }
};

inline const isa::OpRow& row_of(const VirtualInst& inst) {
  return isa::op_table()[inst.op];
}
inline bool is_real(const VirtualInst& inst) {
  return inst.kind == VirtualInst::Kind::Real;
}
inline bool is_guarded(const VirtualInst& inst) {
  return inst.guard != kNoRegister;
}
inline bool is_register(const VirtualOperand& o) {
  return o.kind == VirtualOperand::Kind::Register;
}
inline bool is_constant(const VirtualOperand& o) {
  return o.kind == VirtualOperand::Kind::Constant;
}

// Calls visit(slot, kind) for each operand slot. The parts of a vector are visited one by one as Dst32 or
// Src32.
template <class Visit>
void for_each_slot(const isa::OpRow& row, Visit&& visit) {
  using isa::OperandKind;
  size_t slot = 0;
  for (OperandKind kind : row.operands.view()) {
    OperandKind part = kind;
    if (kind == OperandKind::DstVec2 || kind == OperandKind::DstVec4) part = OperandKind::Dst32;
    if (kind == OperandKind::SrcVec2 || kind == OperandKind::SrcVec4) part = OperandKind::Src32;
    for (int i = 0; i < isa::slots_of(kind); ++i) visit(slot++, part);
  }
}

// Calls visit(register) for each register that the instruction writes.
template <class Visit>
void for_each_def(const VirtualInst& inst, Visit&& visit) {
  if (!is_real(inst)) return;
  for_each_slot(row_of(inst), [&](size_t slot, isa::OperandKind kind) {
    if (isa::is_destination(kind) && is_register(inst.operands[slot])) visit(inst.operands[slot].reg);
  });
}

// Calls visit(register) for each register that the instruction reads, with its guard.
template <class Visit>
void for_each_use(const VirtualInst& inst, Visit&& visit) {
  if (inst.guard != kNoRegister) visit(inst.guard);
  if (!is_real(inst)) return;
  for_each_slot(row_of(inst), [&](size_t slot, isa::OperandKind kind) {
    if (!isa::is_destination(kind) && is_register(inst.operands[slot])) visit(inst.operands[slot].reg);
  });
}

// Returns true for ops whose only effect is what they write. Such an op may be dropped when nothing reads its
// results.
inline bool is_pure(const VirtualInst& inst) {
  if (!is_real(inst)) return false;
  const isa::Freedom freedom = isa::effect_row(row_of(inst).effect).freedom;
  return freedom.may_drop && freedom.may_move;
}

// Returns true for ops that neither steer lanes nor touch rays or calls. Only these ops may be moved.
inline bool is_movable(const VirtualInst& inst) {
  return is_real(inst) && isa::effect_row(row_of(inst).effect).freedom.may_move;
}

inline bool is_call(const VirtualInst& inst) {
  if (!is_real(inst)) return false;
  return isa::is_shader_call(row_of(inst).effect);
}

inline VirtualInst make_inst(uint16_t op, std::vector<VirtualOperand> operands, const isa::Line& line,
                             int32_t imm = 0) {
  VirtualInst inst;
  inst.op = op;
  inst.operands = std::move(operands);
  inst.line = line;
  inst.imm = imm;
  return inst;
}

}  // namespace glint::frontend
