// Decodes instructions for the issue logic.
// SPDX-License-Identifier: Apache-2.0
#include "core/issue_table.h"

#include <algorithm>

#include "base/check.h"
#include "isa/async_copy.h"
#include "isa/barrier.h"
#include "isa/mbarrier.h"

namespace glint::core {
namespace {

using isa::Effect;
using isa::OperandKind;
using isa::Unit;

// Appends the scoreboard entries of one operand. Constants and specials are always ready.
void add_operand(std::vector<uint16_t>& out, OperandKind kind, const isa::Slot* slot) {
  const bool predicate = kind == OperandKind::DstPred || kind == OperandKind::SrcPred;
  const bool pair =
      kind == OperandKind::Dst64 || kind == OperandKind::Src64 || kind == OperandKind::Address64;
  for (int i = 0; i < isa::slots_of(kind); ++i) {
    if (predicate) {
      out.push_back(uint16_t(kFirstPredicate + slot[i]));
    } else if (slot[i] >> isa::kBankShift == 0) {
      out.push_back(slot[i]);
      if (pair) out.push_back(uint16_t(slot[i] + 1));
    }
  }
}

void add_operands(std::vector<uint16_t>& out, const isa::OpRow& row, const isa::Inst& inst,
                  bool destinations) {
  int slot = 0;
  for (OperandKind kind : row.operands.view()) {
    if (isa::is_destination(kind) == destinations) add_operand(out, kind, &inst.operand[slot]);
    slot += isa::slots_of(kind);
  }
}

Finish finish_of(const isa::OpRow& row) {
  const Finish finish = isa::effect_row(row.effect).finish;
  if (row.memory.space == isa::Space::Const || row.memory.space == isa::Space::Param) return Finish::Fixed;
  // Lanes of a warp see each other's accesses in order without a fence.
  const bool orders_warp =
      row.effect == Effect::Fence && isa::FenceScope(row.detail) == isa::FenceScope::Warp;
  return orders_warp ? Finish::Control : finish;
}

// Returns whether the instruction is an mbarrier.* that waits for the copies of its warp.
bool follows_copies(const isa::OpRow& row) {
  return row.effect == Effect::Mbarrier && isa::waits_for_copies(isa::MbarrierKind(row.detail));
}

uint16_t fence_latency(const isa::OpRow& row, const FenceParams& params) {
  const auto scope = isa::FenceScope(row.detail);
  return uint16_t(scope == isa::FenceScope::Block ? params.block
                  : scope == isa::FenceScope::Gpu ? params.gpu
                                                  : params.system);
}

Stall wait_of(const isa::OpRow& row, Finish finish) {
  if (finish == Finish::Memory) {
    if (row.effect == Effect::Load || row.effect == Effect::Atomic || row.effect == Effect::Mbarrier)
      return row.memory.space == isa::Space::Local    ? Stall::LocalMemory
             : row.memory.space == isa::Space::Shared ? Stall::SharedMemory
                                                      : Stall::LongScoreboard;
    return Stall::Texture;  // Stores have no dependents.
  }
  if (finish == Finish::Rays) return Stall::RtWait;
  if (finish == Finish::Barrier || finish == Finish::Reorder) return Stall::Barrier;
  if (finish == Finish::Fence) return Stall::Fence;
  if (finish == Finish::Copies) return Stall::LongScoreboard;
  if (finish == Finish::Control) return Stall::Branch;
  if (finish == Finish::CallRecord) return Stall::Call;
  if (row.unit == Unit::Const) return Stall::Const;
  return pipe_of(row.unit) == Pipe::Sfu ? Stall::RawSfu : Stall::RawFixed;
}

void take_time(IssueRow& row, const OpTime& time) {
  if (time.pipe != Unit::Count) row.pipe = pipe_of(time.pipe);
  row.latency = uint16_t(time.latency);
  row.interval = uint16_t(time.interval * OpTime::kParts);
  row.alternates = time.alternates;
  row.is_sequence = time.issues > 1;
  row.is_whole = time.whole;
  row.slow_path = time.slow_path;
}

// Returns whether the instruction adds the constant one to words of shared memory and returns nothing.
// Hopper's assembler has an instruction of its own for that.
bool counts_up(const isa::OpRow& op, const isa::Inst& inst, const exec::Image& image) {
  if (op.name != "red.shared.add.u32" && op.name != "red.shared.add.s32") return false;
  const isa::Slot addend = inst.operand[1];
  return addend >> isa::kBankShift == isa::kConstantBank >> isa::kBankShift &&
         image.constants.get()[size_t(addend & isa::kSlotIndexMask) * kLanes] == 1;
}

bool is_value(const IssueRow& row, const isa::OpRow& op) {
  return op.effect == Effect::None && !isa::has_lane_mask(op) && row.finish == Finish::Fixed &&
         row.pipe != Pipe::Memory && row.pipe != Pipe::Const && !row.is_sequence && !row.is_whole &&
         row.num_uses <= IssueRow::kFirstUses && row.num_defs <= 1;
}

Door door_of(const IssueRow& row, const TextureParams& texture) {
  if (row.finish == Finish::Rays) return Door::RtUnit;
  if (row.finish != Finish::Memory && row.finish != Finish::CallRecord) return Door::None;
  return row.is_texture && texture.queue > 0 ? Door::Texture : Door::Lsu;
}

}  // namespace

Pipe pipe_of(Unit unit) {
  switch (unit) {
    case Unit::Int:
    case Unit::Move:
    case Unit::Predicate:
      return Pipe::Int;
    case Unit::Fp16:
    case Unit::Fp32:
      return Pipe::Fp32;
    case Unit::Fp64Div:
    case Unit::Fp64:
      return Pipe::Fp64;
    case Unit::Shuffle:
    case Unit::Sfu:
    case Unit::IntDiv:
    case Unit::FpDiv:
      return Pipe::Sfu;
    case Unit::Tensor:
      return Pipe::Tensor;
    case Unit::Const:
      return Pipe::Const;
    case Unit::Barrier:
    case Unit::Branch:
      return Pipe::Branch;
    case Unit::RtUnit:
      return Pipe::RtUnit;
    case Unit::Lsu:
    case Unit::Tex:
      return Pipe::Memory;
    case Unit::Count:
      break;
  }
  GLINT_PANIC("unit {}", int(unit));
}

IssueTable::IssueTable(const exec::Image& image, const Params& params) {
  const auto units = params.units.by_unit();
  const auto op_times = params.op_times.make({});
  rows_.reserve(image.code.size());
  for (size_t pc = 0; pc < image.code.size(); ++pc) {
    const isa::Inst& inst = image.code[pc].inst;
    const isa::OpRow& op = *image.code[pc].row;
    const UnitParams& unit = units[size_t(op.unit)];
    IssueRow row;
    row.first_use = uint32_t(registers_.size());
    add_operands(registers_, op, inst, false);
    row.is_guarded = inst.guard != isa::kNoGuard;
    if (row.is_guarded) registers_.push_back(uint16_t(kFirstPredicate + (inst.guard & ~isa::kGuardNegate)));
    const size_t first_def = registers_.size();
    add_operands(registers_, op, inst, true);
    row.num_uses = uint8_t(registers_.size() - row.first_use);
    row.num_defs = uint8_t(registers_.size() - first_def);
    std::copy_n(uses(row).begin(), std::min(uses(row).size(), IssueRow::kFirstUses), row.first_uses.begin());
    if (row.num_defs > 0) row.first_def = defs(row).front();
    row.finish = finish_of(op);
    row.pipe = row.finish == Finish::Memory ? Pipe::Memory : pipe_of(op.unit);
    row.stage = image.shaders[image.shader_of[pc]].stage;
    row.wait = wait_of(op, row.finish);
    row.is_conditional = op.effect == Effect::Branch && inst.guard != isa::kNoGuard;
    row.latency = row.finish == Finish::Fence ? fence_latency(op, params.fence) : uint16_t(unit.latency);
    if (row.finish == Finish::Copies)
      row.latency =
          isa::CopyGroupKind(op.detail) == isa::CopyGroupKind::Wait ? uint16_t(params.async.copy_wait) : 1;
    row.interval = uint16_t(unit.interval * OpTime::kParts);
    // Functions return from compute programs, which have no other returns. Shaders take the time of the unit.
    const bool ends_function = op.effect == Effect::Return && row.stage == isa::Stage::Compute;
    const bool is_timed = row.finish == Finish::Fixed || ends_function;
    const OpTime* time = is_timed ? op_times->find(op.name) : nullptr;
    if (time) take_time(row, *time);
    issues_.push_back(uint8_t(time ? time->issues : 1));
    if (op.effect == Effect::Atomic) row.atomic = isa::AtomicKind(op.detail);
    row.merges_lanes = params.shared.merges_counts && counts_up(op, inst, image);
    row.is_texture = row.finish == Finish::Memory && op.unit == Unit::Tex;
    row.is_copy = op.effect == Effect::Copy || follows_copies(op);
    row.is_mbarrier = op.effect == Effect::Mbarrier;
    row.door = door_of(row, params.texture);
    row.is_value = is_value(row, op);
    rows_.push_back(row);
    if (params.register_file.banks) count_bank_reads(row, params.register_file);
  }
}

// Counts the register reads by bank. Constants, specials and predicates are not in the banks.
void IssueTable::count_bank_reads(const IssueRow& row, const RegisterFileParams& params) {
  BankReads reads{};
  if (row.finish == Finish::Fixed)
    for (uint16_t r : sources(row))
      if (r < kFirstPredicate) ++reads[r % params.banks];
  for (uint8_t& n : reads) n = uint8_t(std::min<uint32_t>(n, params.window));
  bank_reads_.push_back(reads);
}

}  // namespace glint::core
