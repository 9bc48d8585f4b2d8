// Builds reductions and scans by pointer jumping: each lane knows the member before it, and adds the value of
// that member.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/lower/scan.h"

#include <bit>
#include <cstdint>
#include <limits>

#include "frontend/lower/typed.h"

namespace glint::frontend::scan {
namespace {

using isa::Special;
using enum spv::Op;

constexpr uint32_t kNobody = 0xffff'ffff;  // what bfind returns when no bit is set

Operand shuffle_word(ModuleLowering& l, std::string_view op, const Operand& x, const Operand& lane,
                     const Operand& segment) {
  const Operand result = Operand::of(l.program().new_register(RegisterClass::B32));
  const Operand is_inside = Operand::of(l.program().new_register(RegisterClass::Predicate));
  l.emit().effect(op, {result, is_inside, x, lane, segment, word(0xffff'ffff)});
  return result;
}

// Returns an integer of all ones in the width of the type.
uint64_t ones(Part part) {
  return bytes_of(part) == 8 ? ~uint64_t{0} : (uint64_t{1} << 8 * bytes_of(part)) - 1;
}
uint64_t largest(Part part) {
  return ones(part) >> 1;
}

uint64_t float_bits(Part part, uint16_t half, float single, double full) {
  if (part == Part::Float16) return half;
  return part == Part::Float64 ? std::bit_cast<uint64_t>(full) : std::bit_cast<uint32_t>(single);
}

// Returns the identity of an operation, which the first lane gets from an exclusive scan.
uint64_t identity(spv::Op op, Part part) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  switch (op) {
    case OpGroupNonUniformIMul:
      return 1;
    case OpGroupNonUniformFMul:
      return float_bits(part, 0x3c00, 1.0f, 1.0);
    case OpGroupNonUniformSMin:
      return largest(part);
    case OpGroupNonUniformSMax:
      return largest(part) + 1;
    case OpGroupNonUniformUMin:
    case OpGroupNonUniformBitwiseAnd:
      return ones(part);
    case OpGroupNonUniformFMin:
      return float_bits(part, 0x7c00, kInfinity, double(kInfinity));
    case OpGroupNonUniformFMax:
      return float_bits(part, 0xfc00, -kInfinity, -double(kInfinity));
    default:
      return 0;
  }
}

// Returns the lanes of the cluster that holds each lane.
Operand cluster_mask(Emitter& e, uint32_t size) {
  if (size >= 32) return word(0xffff'ffff);
  const Operand first = e.value("and.b32", {Operand::of(Special::LaneId), word(~(size - 1))});
  return e.value("shl.b32", {word((1u << size) - 1), first});
}

// Returns the lanes that may be combined for a lane, whether they execute or not.
Operand group_mask(Emitter& e, const Lanes& lanes) {
  return lanes.partition ? *lanes.partition : cluster_mask(e, lanes.cluster);
}

// Combines predicates by and, or, or exclusive or. One ballot has all the information.
Operand combine_bools(ModuleLowering& l, spv::Op op, const Operand& x, const Lanes& lanes) {
  Emitter& e = l.emit();
  Operand range = e.value("and.b32", {group_mask(e, lanes), e.fresh("activemask.b32", {})});
  if (lanes.scope == Scope::UpToSelf) range = e.value("and.b32", {range, Operand::of(Special::LanemaskLe)});
  if (lanes.scope == Scope::BeforeSelf) range = e.value("and.b32", {range, Operand::of(Special::LanemaskLt)});
  const Operand votes = e.value("and.b32", {e.fresh("vote.sync.ballot.b32", {x, word(0xffff'ffff)}), range});
  if (op == OpGroupNonUniformLogicalAnd) return e.value("setp.eq.u32", {votes, range});
  if (op == OpGroupNonUniformLogicalOr) return e.value("setp.ne.u32", {votes, word(0)});
  return e.value("setp.ne.u32", {e.value("and.b32", {e.value("popc.b32", {votes}), word(1)}), word(0)});
}

// Emits an inclusive scan in five steps of pointer jumping, or fewer in small clusters. Whichever lanes
// execute, the member before a lane is the highest bit below it. Choice: floats are combined in the order of
// these steps; SPIR-V leaves the order open.
Operand inclusive(ModuleLowering& l, std::string_view name32, Part part, Operand x, Operand before,
                  uint32_t cluster) {
  Emitter& e = l.emit();
  for (uint32_t reach = 1; reach < cluster; reach *= 2) {
    const Operand there = e.value("setp.ne.u32", {before, word(kNobody)});
    const Operand theirs = from_lane(l, part, x, before);
    x = e.select(there, typed(e, name32, part, {theirs, x}), x);
    if (2 * reach < cluster)
      before = e.select(there, from_lane(l, Part::Uint32, before, before), word(kNobody));
  }
  return x;
}

}  // namespace

Operand shuffle(ModuleLowering& l, std::string_view op, Part part, const Operand& x, const Operand& lane,
                const Operand& segment) {
  Emitter& e = l.emit();
  if (part == Part::Bool) {
    const Operand bit = e.value("selp.b32", {word(1), word(0), x});
    return e.value("setp.ne.u32", {shuffle_word(l, op, bit, lane, segment), word(0)});
  }
  if (bytes_of(part) < 8) return shuffle_word(l, op, x, lane, segment);
  const Operand low = e.value("cvt.u32.u64", {x});
  const Operand high = e.value("cvt.u32.u64", {e.value("shr.u64", {x, word(32)})});
  const Operand new_low = shuffle_word(l, op, low, lane, segment),
                new_high = shuffle_word(l, op, high, lane, segment);
  return e.value("pack.b64", {new_low, new_high});
}

Operand from_lane(ModuleLowering& l, Part part, const Operand& x, const Operand& lane) {
  return shuffle(l, "shfl.sync.idx.b32", part, x, lane, word(31));
}

Operand lowest(ModuleLowering& l, const Operand& bits) {
  Emitter& e = l.emit();
  return e.value("bfind.u32", {e.value("and.b32", {bits, e.value("neg.s32", {bits})})});
}

Operand combine(ModuleLowering& l, spv::Op op, std::string_view name32, Part part, const Operand& x,
                const Lanes& lanes) {
  Emitter& e = l.emit();
  if (part == Part::Bool) return combine_bools(l, op, x, lanes);
  const Operand group = group_mask(e, lanes);
  const std::string reduction = "redux.sync." + std::string(name32);
  const bool is_word = part == Part::Int32 || part == Part::Uint32;
  if (lanes.scope == Scope::All && is_word && isa::find_op(reduction) >= 0)
    return e.fresh(reduction, {x, group});
  const Operand members = e.value("and.b32", {group, e.fresh("activemask.b32", {})});
  const Operand before =
      e.value("bfind.u32", {e.value("and.b32", {members, Operand::of(Special::LanemaskLt)})});
  const Operand sum = inclusive(l, name32, part, x, before, lanes.cluster);
  if (lanes.scope == Scope::UpToSelf) return sum;
  if (lanes.scope == Scope::All) return from_lane(l, part, sum, e.value("bfind.u32", {members}));
  const Operand there = e.value("setp.ne.u32", {before, word(kNobody)});
  return e.select(there, from_lane(l, part, sum, before), Operand::value(identity(op, part)));
}

}  // namespace glint::frontend::scan
