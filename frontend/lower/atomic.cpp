// Lowers atomic reads, writes and changes of memory and of texels, and barriers.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <fmt/format.h>
#include <utility>

#include "frontend/lower/lowering.h"
#include "frontend/lower/typed.h"

namespace glint::frontend {
namespace {

// Returns the end of an op's name for the width of the type, such as "add.u32". The ISA adds halves with
// .noftz.f16.
std::string op_suffix(std::string_view name32, Part part) {
  if (part == Part::Float16) return name32 == "add.f32" ? "add.noftz.f16" : with_bits(name32, 16);
  return bytes_of(part) == 8 ? with_bits(name32, 64) : std::string(name32);
}

// Returns the name of the ISA's op for that place, which the ISA may lack. The name is empty for memory of
// one lane.
std::string op_name(const Pointer& pointer, const std::string& suffix) {
  const size_t dot = suffix.find('.');
  switch (pointer.space) {
    case PointerSpace::Texel:
      return fmt::format("suatom.p.{}.{}{}.trap", suffix.substr(0, dot), pointer.shape, suffix.substr(dot));
    case PointerSpace::Global:
      return "atom.global." + suffix;
    case PointerSpace::Shared:
      return "atom.shared." + suffix;
    default:
      return {};
  }
}

// Emits the atomic op and returns the old value.
Operand atomic_op(ModuleLowering& l, const std::string& name, const Pointer& pointer, Part part,
                  const Operands& operands) {
  const bool is_texel = pointer.space == PointerSpace::Texel;
  const Pointer p = is_texel ? pointer : in_reach(l, pointer);
  const Operand old = Operand::of(l.program().new_register(class_of(part)));
  Operands all{old};
  if (is_texel)
    all.insert(all.end(), p.texel.begin(), p.texel.end());
  else
    all.push_back(p.base);
  all.insert(all.end(), operands.begin(), operands.end());
  l.emit().effect(name, std::move(all), is_texel ? 0 : int32_t(p.displacement));
  l.note_store(is_texel ? PointerSpace::Global : p.space);
  return old;
}

// Returns what an op that the ISA lacks would store, from the old value and the operand.
Operand combined(ModuleLowering& l, std::string_view name32, Part part, const Operand& old,
                 const Operand& x) {
  if (name32 == "exch.b32") return x;
  return typed(l.emit(), name32 == "add.f32" ? "add.rn.f32" : name32, part, {old, x});
}

// Emits an atomic change as a loop: compare and swap until no other thread came in between.
Operand change_by_loop(ModuleLowering& l, const std::string& compare, const Pointer& pointer, Part part,
                       std::string_view name32, const Operand& x) {
  Emitter& e = l.emit();
  const Operand old = Operand::of(l.program().new_register(class_of(part)));
  const BlockId again = e.new_block("atomic_again"), retry = e.new_block("atomic_retry"),
                done = e.new_block("atomic_done");
  // Exchanging 0 for 0 reads the value and changes nothing.
  e.copy(old.reg, class_of(part),
         atomic_op(l, compare, pointer, part, {Operand::value(0), Operand::value(0)}));
  e.push_reconvergence(done);
  e.place(again);
  const Operand found = atomic_op(l, compare, pointer, part, {old, combined(l, name32, part, old, x)});
  const Operand is_done = e.fresh(bytes_of(part) == 8 ? "setp.eq.u64" : "setp.eq.u32", {found, old});
  e.branch_if(is_done, true, done);
  e.place(retry);
  e.copy(old.reg, class_of(part), found);
  e.branch(again);
  e.place(done);
  e.effect("join", {});
  return old;
}

// Emits an atomic change and returns the old value. It reports the op as unsupported when the ISA has neither
// the op nor a compare-and-swap of that width.
Operand change(ModuleLowering& l, const Pointer& pointer, Part part, std::string_view name32,
               const Operands& operands) {
  const std::string name = op_name(pointer, op_suffix(name32, part));
  if (name.empty()) {
    if (pointer.space != PointerSpace::Nowhere) l.unsupported("an atomic on memory of one lane");
    return Operand::value(0);
  }
  if (isa::find_op(name) >= 0 && bytes_of(part) != 1) return atomic_op(l, name, pointer, part, operands);
  const std::string compare = op_name(pointer, with_bits("cas.b32", 8 * bytes_of(part)));
  if (isa::find_op(compare) >= 0 && operands.size() == 1)
    return change_by_loop(l, compare, pointer, part, name32, operands[0]);
  l.unsupported(fmt::format("no op {} ({} bits)", name, 8 * bytes_of(part)));
  return Operand::value(0);
}

// The operands are: pointer, scope, semantics, value.
void read_modify_write(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  const Part part = l.part_of(inst.type);
  l.set(inst.result,
        {change(l, l.pointer(inst.operands[0]), part, row.name32, {l.scalar(inst.operands[3])})});
}

void subtract(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Part part = l.part_of(inst.type);
  const Operand less = typed(l.emit(), "neg.s32", part, {l.scalar(inst.operands[3])});
  l.set(inst.result, {change(l, l.pointer(inst.operands[0]), part, "add.u32", {less})});
}

void step(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Part part = l.part_of(inst.type);
  const Operand by = Operand::value(inst.op == spv::Op::OpAtomicIIncrement ? 1
                                    : bytes_of(part) == 8                  ? ~uint64_t{0}
                                                                           : 0xffff'ffff);
  l.set(inst.result, {change(l, l.pointer(inst.operands[0]), part, "add.u32", {by})});
}

// The operands are: pointer, scope, semantics if equal, semantics if unequal, value, comparator.
void compare_exchange(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Operands operands{l.scalar(inst.operands[5]), l.scalar(inst.operands[4])};
  l.set(inst.result, {change(l, l.pointer(inst.operands[0]), l.part_of(inst.type), "cas.b32", operands)});
}

// Model: plain loads and stores of up to 64 bits are atomic.
void atomic_load(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Pointer p = l.pointer(inst.operands[0]);
  if (p.space == PointerSpace::Texel)
    return l.set(inst.result, {change(l, p, l.part_of(inst.type), "or.b32", {Operand::value(0)})});
  p.is_volatile = true;
  l.set(inst.result, l.load(p));
}

void atomic_store(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Pointer p = l.pointer(inst.operands[0]);
  const Operand value = l.scalar(inst.operands[3]);
  if (p.space == PointerSpace::Texel) {
    change(l, p, l.part_of(l.type_of(inst.operands[3])), "exch.b32", {value});
    return;
  }
  p.is_volatile = true;
  l.store(p, {value});
}

// Forgets values of memory that other threads may have changed, so that they are loaded again.
void forget_memory(ModuleLowering& l) {
  l.note_store(PointerSpace::Global);
  l.note_store(PointerSpace::Shared);
}

void fence(ModuleLowering& l, spv::Scope scope) {
  switch (scope) {
    case spv::Scope::CrossDevice:
      l.emit().effect("membar.sys", {});
      break;
    case spv::Scope::Device:
    case spv::Scope::QueueFamily:
    case spv::Scope::ShaderCallKHR:
      l.emit().effect("membar.gl", {});
      break;
    case spv::Scope::Workgroup:
      l.emit().effect("membar.cta", {});
      break;
    default:
      break;  // Model: lanes of a warp see each other's stores in program order
  }
  forget_memory(l);
}

void memory_barrier(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  fence(l, spv::Scope(l.module().constant_u32(inst.operands[0]).value_or(uint32_t(spv::Scope::Device))));
}

// The operands are: scope of execution, scope of memory, semantics. A barrier of the block also orders the
// memory accesses that the block sees.
void control_barrier(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const auto execution =
      spv::Scope(l.module().constant_u32(inst.operands[0]).value_or(uint32_t(spv::Scope::Workgroup)));
  const auto memory =
      spv::Scope(l.module().constant_u32(inst.operands[1]).value_or(uint32_t(spv::Scope::Workgroup)));
  if (memory == spv::Scope::Device || memory == spv::Scope::QueueFamily || memory == spv::Scope::CrossDevice)
    fence(l, memory);
  if (execution == spv::Scope::Workgroup)
    l.emit().effect("bar.sync", {Operand::value(0), Operand::value(0)});
  else if (execution == spv::Scope::Subgroup)
    l.emit().effect("bar.warp.sync", {Operand::value(0xffff'ffff)});
  else
    l.unsupported("OpControlBarrier beyond the workgroup");
  forget_memory(l);
}

using enum spv::Op;
constexpr LoweringRow kAtomicRows[] = {
    {OpAtomicLoad, atomic_load, ""},
    {OpAtomicStore, atomic_store, ""},
    {OpAtomicExchange, read_modify_write, "exch.b32"},
    {OpAtomicCompareExchange, compare_exchange, ""},
    {OpAtomicIIncrement, step, ""},
    {OpAtomicIDecrement, step, ""},
    {OpAtomicIAdd, read_modify_write, "add.u32"},
    {OpAtomicISub, subtract, ""},
    {OpAtomicSMin, read_modify_write, "min.s32"},
    {OpAtomicUMin, read_modify_write, "min.u32"},
    {OpAtomicSMax, read_modify_write, "max.s32"},
    {OpAtomicUMax, read_modify_write, "max.u32"},
    {OpAtomicAnd, read_modify_write, "and.b32"},
    {OpAtomicOr, read_modify_write, "or.b32"},
    {OpAtomicXor, read_modify_write, "xor.b32"},
    {OpAtomicFAddEXT, read_modify_write, "add.f32"},
    {OpAtomicFMinEXT, read_modify_write, "min.f32"},
    {OpAtomicFMaxEXT, read_modify_write, "max.f32"},
    {OpMemoryBarrier, memory_barrier, ""},
    {OpControlBarrier, control_barrier, ""},
};

}  // namespace

std::span<const LoweringRow> atomic_rows() {
  return kAtomicRows;
}

}  // namespace glint::frontend
