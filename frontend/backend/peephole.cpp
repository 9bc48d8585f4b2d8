// Simplifies code by definitions and uses of registers that have a single definition.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/peephole.h"

#include <limits>

#include "frontend/backend/def_use.h"
#include "frontend/backend/liveness.h"
#include "frontend/backend/unchanged.h"

namespace glint::frontend {
namespace {

using Operand = VirtualOperand;

// Returns true for special registers whose value never changes while a shader runs.
bool is_fixed(isa::Special s) {
  return s == isa::Special::LaneId || (s >= isa::Special::LaunchX && s <= isa::Special::LaunchSizeZ);
}

// Makes one sweep over the program. It changes instructions in place and neither adds nor removes any.
class Sweep {
 public:
  Sweep(VirtualProgram& program, const Ops& ops) : program_(program), ops_(ops), registers_(program) {}

  bool run() {
    const std::vector<bool> enters_inside = enters_in_region(program_);
    for (BlockId b = 0; b < program_.blocks.size(); ++b) {
      block_ = &program_.blocks[b];
      inside_region_ = enters_inside[b];
      for (VirtualInst& inst : program_.blocks[b].code) {
        if (inst.kind == VirtualInst::Kind::SaveLive) inside_region_ = true;
        if (inst.kind == VirtualInst::Kind::RestoreLive) inside_region_ = false;
        forward_guard(inst);
        if (!is_real(inst)) continue;
        for_each_slot(row_of(inst), [&](size_t slot, isa::OperandKind kind) { forward(inst, slot, kind); });
        if (is_guarded(inst)) continue;
        fuse_add(inst);
        split_pair(inst);
      }
    }
    return changed_;
  }

 private:
  const VirtualInst* definition(const Operand& o) const { return registers_.definition(o); }
  // Returns true when the operand has the same value at every place that the definition of its user reaches.
  bool is_stable(const Operand& o) const {
    return is_constant(o) || definition(o) != nullptr ||
           (o.kind == Operand::Kind::Special && is_fixed(o.special));
  }
  // Returns true when the operand has the same value at `inst` as at `source`.
  bool is_unchanged(const Operand& o, const VirtualInst& source, const VirtualInst& inst) const {
    return is_stable(o) || frontend::is_unchanged(registers_, *block_, o, source, inst);
  }
  bool is_used_once(const Operand& o) const { return registers_.is_used_once(o); }

  void replace(Operand& operand, const Operand& by) {
    if (is_register(operand)) --registers_.uses[operand.reg];
    if (is_register(by)) ++registers_.uses[by.reg];
    operand = by;
    changed_ = true;
  }

  void forward_guard(VirtualInst& inst) {
    if (!is_guarded(inst)) return;
    const VirtualInst* source = definition(Operand::of(inst.guard));
    if (!source || (source->op != ops_.not_pred && source->op != ops_.mov_pred) ||
        !is_register(source->operands[1]) || !is_stable(source->operands[1]))
      return;
    --registers_.uses[inst.guard];
    inst.guard = source->operands[1].reg;
    ++registers_.uses[inst.guard];
    inst.guard_negate ^= source->op == ops_.not_pred;
    changed_ = true;
  }

  void forward(VirtualInst& inst, size_t slot, isa::OperandKind kind) {
    if (isa::is_destination(kind)) return;
    Operand& operand = inst.operands[slot];
    if (kind == isa::OperandKind::Address32 || kind == isa::OperandKind::Address64) {
      fold_address(inst, operand, kind);
      return;
    }
    const VirtualInst* source = definition(operand);
    if (!source) return;
    if (ops_.is_move(source->op)) {
      const Operand& from = source->operands[1];
      if (is_stable(from) && !(kind == isa::OperandKind::SrcPred && !is_register(from)))
        replace(operand, from);
    } else if (source->op == ops_.not_pred && (inst.op == ops_.selp_b32 || inst.op == ops_.selp_b64) &&
               slot == 3 && is_stable(source->operands[1])) {
      std::swap(inst.operands[1], inst.operands[2]);
      replace(operand, source->operands[1]);
    }
  }

  void fold_address(VirtualInst& inst, Operand& base, isa::OperandKind kind) {
    const bool wide = kind == isa::OperandKind::Address64;
    if (is_constant(base) && !wide && base.constant != 0) {
      if (add_displacement(inst, int32_t(uint32_t(base.constant)), kind)) replace(base, Operand::value(0));
      return;
    }
    const VirtualInst* source = definition(base);
    if (!source) return;
    const auto may_be_base = [&](const Operand& o) {
      if (o.kind == Operand::Kind::StackPointer) return !wide && !inside_region_;
      return (is_register(o) && is_stable(o)) || (!wide && is_constant(o));
    };
    if (source->op == ops_.mov_b32 || source->op == ops_.mov_b64) {
      if (may_be_base(source->operands[1])) replace(base, source->operands[1]);
      return;
    }
    const bool is_add = wide ? source->op == ops_.add_u64 || source->op == ops_.add_s64
                             : source->op == ops_.add_u32 || source->op == ops_.add_s32;
    if (!is_add) return;
    for (size_t k : {size_t{1}, size_t{2}}) {
      const Operand &from = source->operands[k], &offset = source->operands[3 - k];
      if (!may_be_base(from) || !is_constant(offset)) continue;
      const int64_t bytes = wide ? int64_t(offset.constant) : int64_t{int32_t(uint32_t(offset.constant))};
      if (add_displacement(inst, bytes, kind)) replace(base, from);
      return;
    }
  }

  // Adds bytes to the displacement. Choice: displacements of 32-bit addresses stay within [0, 16 MiB), so
  // that base + displacement cannot wrap where the 32-bit addition did not.
  bool add_displacement(VirtualInst& inst, int64_t bytes, isa::OperandKind kind) {
    constexpr int64_t kMostLocal = 1 << 24;
    constexpr int64_t kMost = std::numeric_limits<int32_t>::max(),
                      kLeast = std::numeric_limits<int32_t>::min();
    if (bytes > kMost || bytes < kLeast) return false;
    const int64_t sum = inst.imm + bytes;
    if (kind == isa::OperandKind::Address32 ? (sum < 0 || sum >= kMostLocal || bytes < 0)
                                            : (sum > kMost || sum < kLeast))
      return false;
    inst.imm = int32_t(sum);
    return true;
  }

  // Changes the instruction to `op` with its old destination and these sources.
  void become(VirtualInst& inst, uint16_t op, const std::vector<Operand>& sources) {
    for_each_use(inst, [&](VirtualRegister r) { --registers_.uses[r]; });
    inst.op = op;
    inst.operands.resize(1);
    inst.operands.insert(inst.operands.end(), sources.begin(), sources.end());
    for_each_use(inst, [&](VirtualRegister r) { ++registers_.uses[r]; });
    changed_ = true;
  }

  void fuse_add(VirtualInst& inst) {
    const bool wide = inst.op == ops_.add_u64 || inst.op == ops_.add_s64;
    if (!wide && inst.op != ops_.add_u32 && inst.op != ops_.add_s32) return;
    for (size_t k : {size_t{1}, size_t{2}}) {
      const Operand product = inst.operands[k], addend = inst.operands[3 - k];
      const VirtualInst* source = definition(product);
      if (!source || !is_used_once(product) || addend.kind == Operand::Kind::StackPointer) continue;
      if (wide ? fuse_wide(inst, *source, addend) : fuse_narrow(inst, *source, addend)) return;
    }
  }

  bool fuse_narrow(VirtualInst& inst, const VirtualInst& source, const Operand& addend) {
    if (source.op != ops_.mul_lo_u32 && source.op != ops_.mul_lo_s32 && source.op != ops_.shl_b32)
      return false;
    const Operand a = source.operands[1];
    Operand b = source.operands[2];
    if (source.op == ops_.shl_b32) {
      if (!is_constant(b) || b.constant > 31) return false;
      b = Operand::value(uint64_t{1} << b.constant);
    }
    if (!is_unchanged(a, source, inst) || !is_unchanged(b, source, inst)) return false;
    become(inst, ops_.mad_lo_u32, {a, b, addend});
    return true;
  }

  // Fuses an add.u64 with a mul.wide, or with a widened 32-bit value that may have been shifted.
  bool fuse_wide(VirtualInst& inst, const VirtualInst& first, const Operand& addend) {
    const VirtualInst* source = &first;
    uint64_t shift = 0;
    if (source->op == ops_.shl_b64) {
      if (!is_constant(source->operands[2]) || source->operands[2].constant > 30) return false;
      shift = source->operands[2].constant;
      if (!is_used_once(source->operands[1])) return false;
      source = definition(source->operands[1]);
      if (!source) return false;
    }
    const bool is_signed = source->op == ops_.widen_s32 || source->op == ops_.mul_wide_s32;
    if (source->op == ops_.widen_u32 || source->op == ops_.widen_s32) {
      if (!is_unchanged(source->operands[1], *source, inst)) return false;
      become(inst, is_signed ? ops_.mad_wide_s32 : ops_.mad_wide_u32,
             {source->operands[1], Operand::value(uint64_t{1} << shift), addend});
      return true;
    }
    if (shift != 0 || (source->op != ops_.mul_wide_u32 && source->op != ops_.mul_wide_s32)) return false;
    if (!is_unchanged(source->operands[1], *source, inst) ||
        !is_unchanged(source->operands[2], *source, inst))
      return false;
    become(inst, is_signed ? ops_.mad_wide_s32 : ops_.mad_wide_u32,
           {source->operands[1], source->operands[2], addend});
    return true;
  }

  // Takes the low word of a pack from the pack's source. (unpack writes two registers: unpack_packs() handles
  // it.)
  void split_pair(VirtualInst& inst) {
    if (inst.op != ops_.low_word) return;
    const VirtualInst* source = definition(inst.operands[1]);
    if (!source || (source->op != ops_.pack && source->op != ops_.widen_u32 && source->op != ops_.widen_s32))
      return;
    if (is_stable(source->operands[1])) become(inst, ops_.mov_b32, {source->operands[1]});
  }

  VirtualProgram& program_;
  const Ops& ops_;
  DefUse registers_;
  const VirtualBlock* block_ = nullptr;  // the block that the sweep is in
  bool inside_region_ = false, changed_ = false;
};

// Turns unpack {x, y} of a packed pair into two moves.
bool unpack_packs(VirtualProgram& program, const Ops& ops) {
  std::vector<uint32_t> definitions(program.registers.size());
  // Holds the sources of the pack that defines a register.
  std::vector<std::vector<Operand>> packed(program.registers.size());
  for (const VirtualBlock& block : program.blocks)
    for (const VirtualInst& inst : block.code)
      for_each_def(inst, [&](VirtualRegister r) {
        definitions[r] += is_guarded(inst) ? 2 : 1;
        if (inst.op == ops.pack) packed[r] = {inst.operands[1], inst.operands[2]};
      });
  const auto is_stable = [&](const Operand& o) {
    return is_constant(o) || (is_register(o) && definitions[o.reg] == 1);
  };
  bool changed = false;
  for (VirtualBlock& block : program.blocks) {
    std::vector<VirtualInst> code;
    for (VirtualInst& inst : block.code) {
      const bool is_unpack =
          is_real(inst) && inst.op == ops.unpack && !is_guarded(inst) && is_register(inst.operands[2]);
      const std::vector<Operand> from = is_unpack && definitions[inst.operands[2].reg] == 1
                                            ? packed[inst.operands[2].reg]
                                            : std::vector<Operand>{};
      if (from.empty() || !is_stable(from[0]) || !is_stable(from[1]) ||
          definitions[inst.operands[0].reg] != 1) {
        code.push_back(std::move(inst));
        continue;
      }
      for (size_t k : {size_t{0}, size_t{1}})
        code.push_back(make_inst(ops.mov_b32, {inst.operands[k], from[k]}, inst.line));
      changed = true;
    }
    block.code = std::move(code);
  }
  return changed;
}

}  // namespace

bool drop_dead_code(VirtualProgram& program) {
  const Liveness liveness = find_liveness(program);
  bool changed = false;
  for (BlockId b = 0; b < program.blocks.size(); ++b) {
    LiveWalk walk(liveness.out[b]);
    std::vector<VirtualInst>& code = program.blocks[b].code;
    std::vector<VirtualInst> kept;
    for (size_t i = code.size(); i-- > 0;) {
      bool is_needed = !is_pure(code[i]);
      for_each_def(code[i], [&](VirtualRegister r) { is_needed |= walk.live().contains(r); });
      if (!is_needed) {
        changed = true;
        continue;
      }
      walk.step(code[i]);
      kept.push_back(std::move(code[i]));
    }
    code.assign(std::make_move_iterator(kept.rbegin()), std::make_move_iterator(kept.rend()));
  }
  return changed;
}

void simplify_code(VirtualProgram& program, const Ops& ops) {
  constexpr int kMostRounds = 16;  // each round shortens chains of copies; real programs need three or four
  for (int round = 0; round < kMostRounds; ++round) {
    bool changed = Sweep(program, ops).run();
    changed |= unpack_packs(program, ops);
    changed |= drop_dead_code(program);
    if (!changed) break;
  }
}

}  // namespace glint::frontend
