// Appends virtual instructions, with local value numbering.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/lower/emitter.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/check.h"

namespace glint::frontend {
namespace {

using isa::OperandKind;

RegisterClass class_of_kind(OperandKind kind) {
  if (kind == OperandKind::Dst64 || kind == OperandKind::Src64) return RegisterClass::B64;
  if (kind == OperandKind::DstPred || kind == OperandKind::SrcPred) return RegisterClass::Predicate;
  return RegisterClass::B32;
}

// Returns one operand kind for each operand slot; a vector has several slots of its kind.
std::vector<OperandKind> kinds_by_slot(const isa::OpRow& row) {
  std::vector<OperandKind> kinds;
  for (OperandKind kind : row.operands.view()) kinds.insert(kinds.end(), size_t(isa::slots_of(kind)), kind);
  return kinds;
}

// Returns 1/x where it is exact and normal, which requires that x is a power of two. Then x / y and x * (1/y)
// round the same real number.
std::optional<uint32_t> exact_reciprocal(uint32_t bits) {
  const uint32_t exponent = bits >> 23 & 0xff;
  if ((bits & 0x7f'ffff) != 0 || exponent < 1 || exponent > 253) return std::nullopt;
  return (bits & 0x8000'0000) | (254 - exponent) << 23;
}

void append_key(std::vector<uint64_t>* key, const Operand& operand) {
  key->push_back(uint64_t(operand.kind) << 40 | uint64_t(operand.special) << 32 | operand.reg);
  key->push_back(operand.constant);
}

std::vector<uint64_t> load_key(std::string_view op, const Operand& base, int32_t displacement,
                               uint64_t version) {
  std::vector<uint64_t> key{isa::op_index(op), uint64_t(uint32_t(displacement)), version};
  append_key(&key, base);
  return key;
}

// Drops blocks that nothing branches to, and constructs whose end no lane reaches, because no lanes meet
// there. Branches whose conditions turned out constant leave such blocks.
void drop_unreachable(VirtualProgram& program, std::vector<BlockId>& layout) {
  std::vector<uint8_t> reached(program.blocks.size(), 0);
  std::vector<BlockId> work{layout.front()};
  reached[layout.front()] = 1;
  while (!work.empty()) {
    const BlockId from = work.back();
    work.pop_back();
    for (BlockId to : program.blocks[from].successors)
      if (!std::exchange(reached[to], 1)) work.push_back(to);
  }
  std::erase_if(layout, [&](BlockId block) { return !reached[block]; });
  for (BlockId block : layout)
    std::erase_if(program.blocks[block].code, [&](const VirtualInst& inst) {
      return inst.kind == VirtualInst::Kind::Real && inst.op == isa::op_index("ssy") && !reached[inst.target];
    });
}

}  // namespace

bool is_constant(const Operand& operand, uint64_t bits) {
  return operand.kind == Operand::Kind::Constant && operand.constant == bits;
}

bool same(const Operand& a, const Operand& b) {
  return a.kind == b.kind && a.reg == b.reg && a.constant == b.constant && a.special == b.special;
}

BlockId Emitter::new_block(std::string name) {
  program_.blocks.push_back({std::move(name), {}, {}});
  return BlockId(program_.blocks.size() - 1);
}

void Emitter::place(BlockId block) {
  if (open_) add_successor(block);
  layout_.push_back(block);
  here_ = block;
  open_ = true;
}

void Emitter::add_successor(BlockId to) {
  auto& successors = program_.blocks[here_].successors;
  if (std::find(successors.begin(), successors.end(), to) == successors.end()) successors.push_back(to);
}

VirtualInst& Emitter::append(std::string_view op, Operands operands, int32_t displacement) {
  GLINT_CHECK(open_, "{} after the end of block {}", op,
              here_ == kNoBlock ? "?" : program_.blocks[here_].name);
  VirtualInst inst;
  inst.op = isa::op_index(op);
  inst.imm = displacement;
  inst.operands = std::move(operands);
  inst.line = line_;
  // A predicate is always in a register, and so is each part of a vector.
  const isa::OpRow& row = isa::op_table()[inst.op];
  const std::vector<OperandKind> kinds = kinds_by_slot(row);
  GLINT_CHECK(kinds.size() == inst.operands.size(), "{} takes {} operands, got {}", op, kinds.size(),
              inst.operands.size());
  for (size_t i = 0; i < kinds.size(); ++i) {
    if (kinds[i] == OperandKind::SrcPred)
      inst.operands[i] = in_register(inst.operands[i], RegisterClass::Predicate);
    if (kinds[i] == OperandKind::SrcVec2 || kinds[i] == OperandKind::SrcVec4)
      inst.operands[i] = in_register(inst.operands[i], RegisterClass::B32);
  }
  auto& code = program_.blocks[here_].code;
  code.push_back(std::move(inst));
  return code.back();
}

Operand Emitter::fresh(std::string_view op, Operands sources) {
  const isa::OpRow& row = isa::op_table()[isa::op_index(op)];
  const Operand to = Operand::of(program_.new_register(class_of_kind(row.operands.kind[0])));
  sources.insert(sources.begin(), to);
  append(op, std::move(sources), 0);
  return to;
}

Operand Emitter::value(std::string_view op, Operands sources) {
  if (const Folded result = fold(op, sources); result.folded) return result.operand;
  if (op == "div.rn.f32" && sources[1].kind == Operand::Kind::Constant)
    if (const auto reciprocal = exact_reciprocal(uint32_t(sources[1].constant)))
      return value("mul.rn.f32", {sources[0], Operand::value(*reciprocal)});
  if (op == "mul.lo.u32" || op == "mul.lo.s32") {  // x * 2^k: the factor may stand on either side
    for (int i = 0; i < 2; ++i)
      if (sources[i].kind == Operand::Kind::Constant && std::has_single_bit(sources[i].constant))
        return value("shl.b32",
                     {sources[1 - i], Operand::value(uint64_t(std::countr_zero(sources[i].constant)))});
  }
  if (sources.size() == 2 && sources[1].kind == Operand::Kind::Constant &&
      std::has_single_bit(sources[1].constant)) {
    const uint64_t log2 = uint64_t(std::countr_zero(sources[1].constant));
    if (op == "div.u32") return value("shr.u32", {sources[0], Operand::value(log2)});
    if (op == "rem.u32") return value("and.b32", {sources[0], Operand::value(sources[1].constant - 1)});
  }
  std::vector<uint64_t> key{isa::op_index(op)};
  for (const Operand& source : sources) append_key(&key, source);
  if (const auto it = known_.find(key); it != known_.end()) {
    if (!free_) free_results_.erase(it->second[0].reg);
    return it->second[0];
  }
  const Operand result = fresh(op, sources);
  if (free_) free_results_.insert(result.reg);
  if (op == "not.pred") negation_of_[result.reg] = sources[0].reg;
  known_[key] = {result};
  return result;
}

Operands Emitter::load(std::string_view op, const Operand& base, int32_t displacement, int count,
                       uint64_t version) {
  const std::vector<uint64_t> key = load_key(op, base, displacement, version);
  if (version != 0)
    if (const auto it = known_.find(key); it != known_.end()) return it->second;
  const RegisterClass c = class_of_kind(isa::op_table()[isa::op_index(op)].operands.kind[0]);
  Operands results;
  for (int i = 0; i < count; ++i) results.push_back(Operand::of(program_.new_register(c)));
  Operands operands = results;
  operands.push_back(base);
  append(op, std::move(operands), displacement);
  if (version == 0) return results;
  known_[key] = results;
  if (const size_t vector = op.find(".v"); vector != std::string_view::npos)
    for (int i = 0; i < count; ++i)
      remember(std::string(op.substr(0, vector)) + ".b32", base, displacement + 4 * i, version,
               results[size_t(i)]);
  return results;
}

void Emitter::remember(std::string_view op, const Operand& base, int32_t displacement, uint64_t version,
                       const Operand& word) {
  known_[load_key(op, base, displacement, version)] = {word};
}

Operand Emitter::in_register(const Operand& operand, RegisterClass c) {
  if (operand.kind == Operand::Kind::Register) return operand;
  if (c == RegisterClass::Predicate)
    return fresh("setp.ne.u32", {Operand::value(operand.constant), Operand::value(0)});
  return fresh(c == RegisterClass::B64 ? "mov.b64" : "mov.b32", {operand});
}

void Emitter::copy(VirtualRegister to, RegisterClass c, const Operand& from) {
  if (c == RegisterClass::Predicate && from.kind == Operand::Kind::Constant) {
    append("setp.ne.u32", {Operand::of(to), Operand::value(from.constant), Operand::value(0)}, 0);
    return;
  }
  const std::string_view op = c == RegisterClass::B32   ? "mov.b32"
                              : c == RegisterClass::B64 ? "mov.b64"
                                                        : "mov.pred";
  append(op, {Operand::of(to), from}, 0);
}

VirtualInst& Emitter::effect(std::string_view op, Operands operands, int32_t displacement) {
  return append(op, std::move(operands), displacement);
}

void Emitter::marker(VirtualInst::Kind kind) {
  VirtualInst inst;
  inst.kind = kind;
  inst.line = line_;
  program_.blocks[here_].code.push_back(std::move(inst));
}

void Emitter::push_reconvergence(BlockId at) {
  append("ssy", {}, 0).target = at;
}

void Emitter::branch(BlockId to) {
  append("bra", {}, 0).target = to;
  add_successor(to);
  open_ = false;
}

void Emitter::branch_if(const Operand& predicate, bool when, BlockId to) {
  Operand guard = in_register(predicate, RegisterClass::Predicate);
  // The source of a negation still has the same value, because a phi's register changes only on the edges
  // into its block.
  for (auto it = negation_of_.find(guard.reg); it != negation_of_.end(); it = negation_of_.find(guard.reg)) {
    guard.reg = it->second;
    when = !when;
  }
  VirtualInst& inst = append("bra", {}, 0);
  inst.guard = guard.reg;
  inst.guard_negate = !when;
  inst.target = to;
  add_successor(to);
}

void Emitter::end(std::string_view op) {
  append(op, {}, 0);
  open_ = false;
}

RegisterClass Emitter::class_of(const Operand& operand, RegisterClass of_constant) const {
  if (operand.kind == Operand::Kind::Register) return program_.registers[operand.reg];
  return operand.kind == Operand::Kind::Constant ? of_constant : RegisterClass::B32;
}

Operand Emitter::select(Operand predicate, Operand a, Operand b) {
  const bool is_64 = class_of(a) == RegisterClass::B64 || class_of(b) == RegisterClass::B64;
  return value(is_64 ? "selp.b64" : "selp.b32", {a, b, predicate});
}

Operand Emitter::select_bool(Operand predicate, Operand a, Operand b) {
  const Operand if_true = value("and.pred", {predicate, a});
  const Operand if_false = value("and.pred", {value("not.pred", {predicate}), b});
  return value("or.pred", {if_true, if_false});
}

void Emitter::finish() {
  drop_unreachable(program_, layout_);
  std::vector<BlockId> place_of(program_.blocks.size(), kNoBlock);
  for (size_t i = 0; i < layout_.size(); ++i) place_of[layout_[i]] = BlockId(i);
  std::vector<VirtualBlock> blocks;
  const auto renumber = [&](BlockId* block) {
    GLINT_CHECK(place_of[*block] != kNoBlock, "block {} is a target but was never placed",
                program_.blocks[*block].name);
    *block = place_of[*block];
  };
  for (size_t i = 0; i < layout_.size(); ++i) {
    VirtualBlock& block = program_.blocks[layout_[i]];
    for (VirtualInst& inst : block.code)
      if (inst.target != kNoBlock) renumber(&inst.target);
    for (BlockId& successor : block.successors) renumber(&successor);
    if (!block.code.empty()) {
      const VirtualInst& last = block.code.back();
      if (last.kind == VirtualInst::Kind::Real && last.guard == kNoRegister &&
          last.op == isa::op_index("bra") && last.target == i + 1)
        block.code.pop_back();
    }
    blocks.push_back(std::move(block));
  }
  program_.blocks = std::move(blocks);
}

}  // namespace glint::frontend
