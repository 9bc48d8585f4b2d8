// Lowers subgroup operations: votes, ballots, shuffles, reductions and scans over the executing lanes of a
// warp.
//
// No result is reused or folded, because other lanes may execute at another place in the code.
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "frontend/lower/lowering.h"
#include "frontend/lower/scan.h"
#include "frontend/lower/typed.h"

namespace glint::frontend {
namespace {

using isa::Special;
using enum spv::Op;

// Returns the mask of all lanes. Lanes that do not execute never take part.
Operand all_lanes() {
  return word(0xffff'ffff);
}
Operands ballot_of(const Operand& lanes) {
  return {lanes, word(0), word(0), word(0)};
}

bool is_subgroup(ModuleLowering& l, const Instruction& inst) {
  if (l.module().constant_u32(inst.operands[0]).value_or(3) == uint32_t(spv::Scope::Subgroup)) return true;
  l.unsupported("group operations beyond the subgroup");
  return false;
}

// Calls `f` for each part of operand `at` and collects the results.
template <class F>
void each_part(ModuleLowering& l, const Instruction& inst, size_t at, F&& f) {
  const Part part = l.part_of(inst.type);
  Operands result;
  for (const Operand& x : Operands(l.value(inst.operands[at]))) result.push_back(f(part, x));
  l.set(inst.result, std::move(result));
}

Operand first_lane(Emitter& e, ModuleLowering& l) {
  return scan::lowest(l, e.fresh("activemask.b32", {}));
}

void elect(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  if (!is_subgroup(l, inst)) return;
  l.set(inst.result,
        {l.emit().value("setp.eq.u32", {Operand::of(Special::LaneId), first_lane(l.emit(), l)})});
}

void vote(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  l.set(inst.result, {l.emit().fresh(row.name32, {l.scalar(inst.operands.back()), all_lanes()})});
}

// Compares with the first lane's value. Floats are compared as numbers, as == does.
void all_equal(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Emitter& e = l.emit();
  const Part part = l.part_of(l.type_of(inst.operands.back()));
  const Operand first = first_lane(e, l);
  Operand same = word(1);
  for (const Operand& x : Operands(l.value(inst.operands.back()))) {
    const Operand theirs = scan::from_lane(l, part, x, first);
    const Operand equal = part == Part::Bool
                              ? e.value("not.pred", {e.value("xor.pred", {x, theirs})})
                              : typed(e, is_float(part) ? "setp.eq.f32" : "setp.eq.u32", part, {x, theirs});
    same = is_constant(same, 1) ? equal : e.value("and.pred", {same, equal});
  }
  l.set(inst.result, {e.fresh("vote.sync.all.pred", {same, all_lanes()})});
}

void ballot(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  l.set(inst.result,
        ballot_of(l.emit().fresh("vote.sync.ballot.b32", {l.scalar(inst.operands.back()), all_lanes()})));
}

Operand bit_of(Emitter& e, const Operand& lanes, const Operand& index) {
  const Operand bit = e.value("and.b32", {e.value("shr.u32", {lanes, index}), word(1)});
  return e.value("setp.ne.u32", {bit, word(0)});
}

void inverse_ballot(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  l.set(inst.result, {bit_of(l.emit(), l.value(inst.operands[1])[0], Operand::of(Special::LaneId))});
}

// Extracts a bit of a ballot. Bits beyond the 32 lanes are 0, because a shift by more than 31 gives 0.
void ballot_bit(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  l.set(inst.result, {bit_of(l.emit(), l.value(inst.operands[1])[0], l.scalar(inst.operands[2]))});
}

void ballot_count(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Operand lanes = l.value(inst.operands[2])[0];
  const auto operation = spv::GroupOperation(inst.operands[1]);
  if (operation == spv::GroupOperation::InclusiveScan)
    lanes = l.emit().value("and.b32", {lanes, Operand::of(Special::LanemaskLe)});
  else if (operation == spv::GroupOperation::ExclusiveScan)
    lanes = l.emit().value("and.b32", {lanes, Operand::of(Special::LanemaskLt)});
  l.set(inst.result, {l.emit().value("popc.b32", {lanes})});
}

void find_lowest(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  l.set(inst.result, {scan::lowest(l, l.value(inst.operands[1])[0])});
}
void find_highest(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  l.set(inst.result, {l.emit().value("bfind.u32", {l.value(inst.operands[1])[0]})});
}

// The last two operands are the value, and the lane, its difference or its distance. Older ops have no scope.
void shuffle(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  const size_t at = inst.operands.size() - 2;
  const Operand lane = l.word(inst.operands[at + 1]);
  const Operand segment = word(row.name32 == "shfl.sync.up.b32" ? 0 : 31);
  each_part(l, inst, at, [&](Part part, const Operand& x) {
    return scan::shuffle(l, row.name32, part, x, lane, segment);
  });
}

void broadcast_first(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Operand first = first_lane(l.emit(), l);
  each_part(l, inst, inst.operands.size() - 1,
            [&](Part part, const Operand& x) { return scan::from_lane(l, part, x, first); });
}

void quad_broadcast(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Emitter& e = l.emit();
  const Operand quad = e.value("and.b32", {Operand::of(Special::LaneId), word(~3u)});
  const Operand lane = e.value("or.b32", {quad, l.word(inst.operands[2])});
  each_part(l, inst, 1, [&](Part part, const Operand& x) { return scan::from_lane(l, part, x, lane); });
}

// The direction is 0 for horizontal, 1 for vertical and 2 for diagonal.
void quad_swap(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Operand difference = word(l.module().constant_u32(inst.operands[2]).value_or(0) + 1);
  each_part(l, inst, 1, [&](Part part, const Operand& x) {
    return scan::shuffle(l, "shfl.sync.bfly.b32", part, x, difference, word(31));
  });
}

void rotate(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Emitter& e = l.emit();
  const uint32_t size =
      inst.operands.size() > 3 ? l.module().constant_u32(inst.operands[3]).value_or(32) : 32;
  const Operand self = Operand::of(Special::LaneId);
  const Operand turned =
      e.value("and.b32", {e.value("add.u32", {self, l.word(inst.operands[2])}), word(size - 1)});
  const Operand lane = e.value("or.b32", {e.value("and.b32", {self, word(~(size - 1))}), turned});
  each_part(l, inst, 1, [&](Part part, const Operand& x) { return scan::from_lane(l, part, x, lane); });
}

// Returns the lanes that have the same value in all components.
void partition(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Emitter& e = l.emit();
  const Part part = l.part_of(l.type_of(inst.operands[0]));
  Operand lanes = all_lanes();
  for (Operand x : Operands(l.value(inst.operands[0]))) {
    if (part == Part::Bool) x = e.value("selp.b32", {word(1), word(0), x});
    const Operand same =
        e.fresh(bytes_of(part) == 8 ? "match.any.sync.b64" : "match.any.sync.b32", {x, all_lanes()});
    lanes = e.value("and.b32", {lanes, same});
  }
  l.set(inst.result, ballot_of(lanes));
}

// The operands are: scope, operation, value, then the size of clusters or the ballot of the partition.
void arithmetic(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  if (!is_subgroup(l, inst)) return;
  scan::Lanes lanes;
  switch (spv::GroupOperation(inst.operands[1])) {
    case spv::GroupOperation::Reduce:
      break;
    case spv::GroupOperation::InclusiveScan:
      lanes.scope = scan::Scope::UpToSelf;
      break;
    case spv::GroupOperation::ExclusiveScan:
      lanes.scope = scan::Scope::BeforeSelf;
      break;
    case spv::GroupOperation::ClusteredReduce:
      lanes.cluster = l.module().constant_u32(inst.operands.at(3)).value_or(32);
      break;
    case spv::GroupOperation::PartitionedReduceNV:
      lanes.partition = l.value(inst.operands.at(3))[0];
      break;
    case spv::GroupOperation::PartitionedInclusiveScanNV:
      lanes.partition = l.value(inst.operands.at(3))[0], lanes.scope = scan::Scope::UpToSelf;
      break;
    case spv::GroupOperation::PartitionedExclusiveScanNV:
      lanes.partition = l.value(inst.operands.at(3))[0], lanes.scope = scan::Scope::BeforeSelf;
      break;
    default:
      return l.unsupported("a group operation of this kind");
  }
  each_part(l, inst, 2, [&](Part part, const Operand& x) {
    return scan::combine(l, inst.op, row.name32, part, x, lanes);
  });
}

// Maps the older names of SPV_AMD_shader_ballot to the standard ops.
struct Older {
  spv::Op op, standard;
};
constexpr Older kOlder[] = {
    {OpGroupIAdd, OpGroupNonUniformIAdd},
    {OpGroupFAdd, OpGroupNonUniformFAdd},
    {OpGroupSMin, OpGroupNonUniformSMin},
    {OpGroupUMin, OpGroupNonUniformUMin},
    {OpGroupFMin, OpGroupNonUniformFMin},
    {OpGroupSMax, OpGroupNonUniformSMax},
    {OpGroupUMax, OpGroupNonUniformUMax},
    {OpGroupFMax, OpGroupNonUniformFMax},
    {OpGroupIAddNonUniformAMD, OpGroupNonUniformIAdd},
    {OpGroupFAddNonUniformAMD, OpGroupNonUniformFAdd},
    {OpGroupSMinNonUniformAMD, OpGroupNonUniformSMin},
    {OpGroupUMinNonUniformAMD, OpGroupNonUniformUMin},
    {OpGroupFMinNonUniformAMD, OpGroupNonUniformFMin},
    {OpGroupSMaxNonUniformAMD, OpGroupNonUniformSMax},
    {OpGroupUMaxNonUniformAMD, OpGroupNonUniformUMax},
    {OpGroupFMaxNonUniformAMD, OpGroupNonUniformFMax},
};

void older(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Instruction same = inst;
  for (const Older& row : kOlder)
    if (row.op == inst.op) same.op = row.standard;
  const LoweringRow& row = *find_lowering_row(same.op);
  row.lower(l, same, row);
}

constexpr LoweringRow kSubgroupRows[] = {
    {OpGroupNonUniformElect, elect, ""},
    {OpGroupNonUniformAll, vote, "vote.sync.all.pred"},
    {OpGroupNonUniformAny, vote, "vote.sync.any.pred"},
    {OpGroupNonUniformAllEqual, all_equal, ""},
    {OpSubgroupAllKHR, vote, "vote.sync.all.pred"},
    {OpSubgroupAnyKHR, vote, "vote.sync.any.pred"},
    {OpSubgroupAllEqualKHR, all_equal, ""},
    {OpGroupNonUniformBroadcast, shuffle, "shfl.sync.idx.b32"},
    {OpGroupNonUniformBroadcastFirst, broadcast_first, ""},
    {OpSubgroupReadInvocationKHR, shuffle, "shfl.sync.idx.b32"},
    {OpSubgroupFirstInvocationKHR, broadcast_first, ""},
    {OpGroupNonUniformBallot, ballot, ""},
    {OpSubgroupBallotKHR, ballot, ""},
    {OpGroupNonUniformInverseBallot, inverse_ballot, ""},
    {OpGroupNonUniformBallotBitExtract, ballot_bit, ""},
    {OpGroupNonUniformBallotBitCount, ballot_count, ""},
    {OpGroupNonUniformBallotFindLSB, find_lowest, ""},
    {OpGroupNonUniformBallotFindMSB, find_highest, ""},
    {OpGroupNonUniformShuffle, shuffle, "shfl.sync.idx.b32"},
    {OpGroupNonUniformShuffleXor, shuffle, "shfl.sync.bfly.b32"},
    {OpGroupNonUniformShuffleUp, shuffle, "shfl.sync.up.b32"},
    {OpGroupNonUniformShuffleDown, shuffle, "shfl.sync.down.b32"},
    {OpGroupNonUniformRotateKHR, rotate, ""},
    {OpGroupNonUniformQuadBroadcast, quad_broadcast, ""},
    {OpGroupNonUniformQuadSwap, quad_swap, ""},
    {OpGroupNonUniformPartitionNV, partition, ""},
    {OpGroupNonUniformIAdd, arithmetic, "add.u32"},
    {OpGroupNonUniformFAdd, arithmetic, "add.rn.f32"},
    {OpGroupNonUniformIMul, arithmetic, "mul.lo.u32"},
    {OpGroupNonUniformFMul, arithmetic, "mul.rn.f32"},
    {OpGroupNonUniformSMin, arithmetic, "min.s32"},
    {OpGroupNonUniformUMin, arithmetic, "min.u32"},
    {OpGroupNonUniformFMin, arithmetic, "min.f32"},
    {OpGroupNonUniformSMax, arithmetic, "max.s32"},
    {OpGroupNonUniformUMax, arithmetic, "max.u32"},
    {OpGroupNonUniformFMax, arithmetic, "max.f32"},
    {OpGroupNonUniformBitwiseAnd, arithmetic, "and.b32"},
    {OpGroupNonUniformBitwiseOr, arithmetic, "or.b32"},
    {OpGroupNonUniformBitwiseXor, arithmetic, "xor.b32"},
    {OpGroupNonUniformLogicalAnd, arithmetic, ""},
    {OpGroupNonUniformLogicalOr, arithmetic, ""},
    {OpGroupNonUniformLogicalXor, arithmetic, ""},
    {OpGroupIAdd, older, ""},
    {OpGroupFAdd, older, ""},
    {OpGroupSMin, older, ""},
    {OpGroupUMin, older, ""},
    {OpGroupFMin, older, ""},
    {OpGroupSMax, older, ""},
    {OpGroupUMax, older, ""},
    {OpGroupFMax, older, ""},
    {OpGroupIAddNonUniformAMD, older, ""},
    {OpGroupFAddNonUniformAMD, older, ""},
    {OpGroupSMinNonUniformAMD, older, ""},
    {OpGroupUMinNonUniformAMD, older, ""},
    {OpGroupFMinNonUniformAMD, older, ""},
    {OpGroupSMaxNonUniformAMD, older, ""},
    {OpGroupUMaxNonUniformAMD, older, ""},
    {OpGroupFMaxNonUniformAMD, older, ""},
};

}  // namespace

std::span<const LoweringRow> subgroup_rows() {
  return kSubgroupRows;
}

}  // namespace glint::frontend
