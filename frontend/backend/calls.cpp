// Finds call regions and turns them into stores, loads and moves of the stack pointer.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/calls.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <map>
#include <utility>

#include "base/check.h"
#include "frontend/backend/liveness.h"
#include "frontend/backend/spill.h"

namespace glint::frontend {
namespace {

using Operand = VirtualOperand;

constexpr uint32_t kFrameAlignment = 16;  // bytes; a vector of four words lies in one 16-byte piece

uint32_t round_up(uint32_t bytes) {
  return (bytes + kFrameAlignment - 1) / kFrameAlignment * kFrameAlignment;
}

// Returns the physical registers that hold the region's values, in ascending order. Values merged by the
// allocator share a register.
std::vector<uint16_t> registers_of(const CallRegion& region, const VirtualProgram& program,
                                   const Allocation& allocation) {
  std::bitset<isa::kMaxRegisters + 1> used;
  region.live.for_each([&](VirtualRegister r) {
    // A live predicate here was not live when keep_predicates_across_calls() looked: spilling has renamed
    // guards since, so a value that no lane reads again looks as if some lanes might read it.
    if (program.registers[r] == RegisterClass::Predicate) return;
    used.set(allocation.slot[r]);
    if (program.registers[r] == RegisterClass::B64) used.set(allocation.slot[r] + 1u);
  });
  std::vector<uint16_t> out;
  for (uint16_t r = 0; r < used.size(); ++r)
    if (used[r]) out.push_back(r);
  return out;
}

// Appends one instruction for every four registers, then one for two registers and one for the last.
class Transfer {
 public:
  Transfer(VirtualProgram& program, Allocation& allocation, uint32_t offset)
      : program_(program), allocation_(allocation), offset_(offset) {}

  void append(std::vector<VirtualInst>& out, const std::vector<uint16_t>& registers, bool is_store,
              const std::array<uint16_t, 3>& ops_by_size, const isa::Line& line) {
    for (size_t i = 0; i < registers.size();) {
      const size_t left = registers.size() - i;
      const size_t count = left >= 4 ? 4 : left >= 2 ? 2 : 1;
      std::vector<Operand> operands;
      for (size_t k = 0; k < count; ++k) operands.push_back(Operand::of(name(registers[i + k])));
      operands.insert(is_store ? operands.begin() : operands.end(), Operand::stack_pointer());
      const uint16_t op = ops_by_size[count / 2];
      out.push_back(make_inst(op, std::move(operands), line, int32_t(offset_ + 4 * i)));
      i += count;
    }
  }

 private:
  // Makes a virtual register that is known to lie in the physical one.
  VirtualRegister name(uint16_t physical) {
    allocation_.slot.push_back(physical);
    return program_.new_register(RegisterClass::B32);
  }

  VirtualProgram& program_;
  Allocation& allocation_;
  uint32_t offset_;
};

void lower_frame_address(VirtualInst& inst, uint32_t frame) {
  if (!is_real(inst)) return;
  for_each_slot(row_of(inst), [&](size_t slot, isa::OperandKind kind) {
    if (inst.operands[slot].kind != Operand::Kind::StackPointer) return;
    GLINT_CHECK(kind == isa::OperandKind::Address32,
                "the stack pointer is read as a value inside a call region ({})", row_of(inst).name);
    inst.imm -= int32_t(frame);
  });
}

void move_stack_pointer(std::vector<VirtualInst>& out, uint16_t op, uint32_t frame, const isa::Line& line) {
  if (frame == 0) return;
  out.push_back(
      make_inst(op, {Operand::stack_pointer(), Operand::stack_pointer(), Operand::value(frame)}, line));
}

}  // namespace

namespace {

// Turns predicates that cross more calls than they have accesses into words in the whole program.
void demote_predicates(VirtualProgram& program, const Ops& ops) {
  std::vector<float> gain(program.registers.size());  // estimated executed instructions
  const std::vector<float> weights = block_weights(program);
  for (const CallRegion& region : find_call_regions(program))
    // A predicate that crosses a region costs a selp and a setp.
    region.live.for_each([&](VirtualRegister r) { gain[r] += 2 * weights[region.save.block]; });
  for (BlockId b = 0; b < program.blocks.size(); ++b)
    for (const VirtualInst& inst : program.blocks[b].code) {
      for_each_def(inst, [&](VirtualRegister r) { gain[r] -= weights[b]; });
      for_each_use(inst, [&](VirtualRegister r) { gain[r] -= weights[b]; });
    }
  std::vector<bool> unspillable(program.registers.size());
  SpillPlan plan{std::vector<VirtualRegister>(program.registers.size(), kNoRegister), &unspillable};
  bool any = false;
  for (VirtualRegister r = 0; r < plan.group.size(); ++r) {
    if (program.registers[r] != RegisterClass::Predicate || gain[r] <= 0) continue;
    plan.group[r] = r;
    any = true;
  }
  if (any) spill(program, ops, plan);
}

}  // namespace

void keep_predicates_across_calls(VirtualProgram& program, const Ops& ops) {
  demote_predicates(program, ops);
  const std::vector<CallRegion> regions = find_call_regions(program);
  // These instructions are inserted before each SaveLive and after each RestoreLive, by block and index.
  std::map<std::pair<BlockId, size_t>, std::vector<VirtualInst>> before, after;
  for (const CallRegion& region : regions) {
    const isa::Line line = program.blocks[region.save.block].code[region.save.index].line;
    region.live.for_each([&](VirtualRegister r) {
      if (program.registers[r] != RegisterClass::Predicate) return;
      const Operand word = Operand::of(program.new_register(RegisterClass::B32));
      before[{region.save.block, region.save.index}].push_back(
          make_inst(ops.selp_b32, {word, Operand::value(1), Operand::value(0), Operand::of(r)}, line));
      after[{region.restore.block, region.restore.index}].push_back(
          make_inst(ops.setp_ne, {Operand::of(r), word, Operand::value(0)}, line));
    });
  }
  if (before.empty()) return;
  for (BlockId b = 0; b < program.blocks.size(); ++b) {
    std::vector<VirtualInst> code;
    for (size_t i = 0; i < program.blocks[b].code.size(); ++i) {
      if (const auto found = before.find({b, i}); found != before.end())
        code.insert(code.end(), found->second.begin(), found->second.end());
      code.push_back(program.blocks[b].code[i]);
      if (const auto found = after.find({b, i}); found != after.end())
        code.insert(code.end(), found->second.begin(), found->second.end());
    }
    program.blocks[b].code = std::move(code);
  }
}

void expand_calls(VirtualProgram& program, Allocation& allocation, const Ops& ops) {
  const std::vector<CallRegion> regions = find_call_regions(program);
  const std::vector<bool> enters_inside = enters_in_region(program);
  // Holds the registers that are moved at each SaveLive and RestoreLive.
  std::map<std::pair<BlockId, size_t>, std::vector<uint16_t>> moved;
  const uint32_t save_area = round_up(program.local_bytes);
  uint32_t frame = save_area;
  for (const CallRegion& region : regions) {
    const std::vector<uint16_t> registers = registers_of(region, program, allocation);
    frame = std::max(frame, round_up(save_area + 4 * uint32_t(registers.size())));
    moved[{region.save.block, region.save.index}] = registers;
    moved[{region.restore.block, region.restore.index}] = registers;
  }
  program.local_bytes = frame;
  Transfer transfer(program, allocation, save_area);
  for (BlockId b = 0; b < program.blocks.size(); ++b) {
    bool inside = enters_inside[b];
    std::vector<VirtualInst> code;
    for (size_t i = 0; i < program.blocks[b].code.size(); ++i) {
      VirtualInst& inst = program.blocks[b].code[i];
      if (inst.kind == VirtualInst::Kind::SaveLive) {
        transfer.append(code, moved[{b, i}], true, {ops.store_b32, ops.store_v2, ops.store_v4}, inst.line);
        move_stack_pointer(code, ops.add_u32, frame, inst.line);
        inside = true;
      } else if (inst.kind == VirtualInst::Kind::RestoreLive) {
        move_stack_pointer(code, ops.sub_u32, frame, inst.line);
        transfer.append(code, moved[{b, i}], false, {ops.load_b32, ops.load_v2, ops.load_v4}, inst.line);
        inside = false;
      } else {
        if (inside) lower_frame_address(inst, frame);
        code.push_back(std::move(inst));
      }
    }
    program.blocks[b].code = std::move(code);
  }
}

}  // namespace glint::frontend
