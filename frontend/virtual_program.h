// Holds the code between lowering and register allocation: ISA ops over unlimited virtual registers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "isa/op_row.h"
#include "isa/program.h"

namespace glint::frontend {

enum class RegisterClass : uint8_t { B32, B64, Predicate };

using VirtualRegister = uint32_t;  // index into VirtualProgram::registers
inline constexpr VirtualRegister kNoRegister = 0xffff'ffff;

struct VirtualOperand {
  // CalleeFrame is the address of the frame of a function that is called, inside of a region of calls: its
  // parameters and results lie there.
  enum class Kind : uint8_t {
    None,
    Register,
    Constant,
    Special,
    StackPointer,
    CalleeFrame
  } kind = Kind::None;
  VirtualRegister reg = kNoRegister;
  uint64_t constant = 0;  // 32 or 64 bits, by the op's operand kind
  isa::Special special = isa::Special::LaneId;
  // A source of one word may name a register of two; this says which of them it reads.
  bool is_high = false;

  static VirtualOperand of(VirtualRegister r) { return {Kind::Register, r, 0, {}, false}; }
  static VirtualOperand value(uint64_t bits) { return {Kind::Constant, kNoRegister, bits, {}, false}; }
  static VirtualOperand of(isa::Special s) { return {Kind::Special, kNoRegister, 0, s, false}; }
  static VirtualOperand stack_pointer() { return {Kind::StackPointer, kNoRegister, 0, {}, false}; }
  static VirtualOperand callee_frame() { return {Kind::CalleeFrame, kNoRegister, 0, {}, false}; }
};

using BlockId = uint32_t;
inline constexpr BlockId kNoBlock = 0xffff'ffff;

struct VirtualInst {
  // A Real instruction has an op of the table. SaveLive and RestoreLive enclose a region with calls: the
  // allocator stores every value that is live across the region to the frame at SaveLive and loads it back at
  // RestoreLive. Within the region, each call.* destroys all registers and predicates except %r0.
  enum class Kind : uint8_t { Real, SaveLive, RestoreLive } kind = Kind::Real;
  uint16_t op = 0;
  VirtualRegister guard = kNoRegister;  // a register of class Predicate
  bool guard_negate = false;
  int32_t imm = 0;                       // displacement in bytes
  BlockId target = kNoBlock;             // block of a Label operand
  std::vector<VirtualOperand> operands;  // one for each operand, in the order of OpRow::operands
  isa::Line line;
};

// Holds a straight run of instructions. Control enters at the top and leaves only through the last
// instructions (guarded bra, then bra, ret, exit, rt.ignore, rt.terminate) or by falling into the next block.
struct VirtualBlock {
  std::string name;
  std::vector<VirtualInst> code;
  std::vector<BlockId> successors;  // all blocks that control may go to next
};

// The most bytes of variables that one thread may have. Source: CUDA C++ Programming Guide, Technical
// Specifications per Compute Capability, "Maximum amount of local memory per thread" (512 KB for all of
// them).
inline constexpr uint64_t kMostLocalBytes = 512 * 1024;

// The program is not in SSA form: phis have become moves. On every path, a definition reaches every use.
struct VirtualProgram {
  std::string name;
  isa::Stage stage = isa::Stage::Compute;
  std::vector<RegisterClass> registers;
  std::vector<VirtualBlock> blocks;  // in layout order; block 0 is the entry
  std::vector<std::string> files;
  std::vector<isa::Scope> scopes;     // isa::Line::scope numbers them from 1
  std::vector<isa::SpirvLine> spirv;  // isa::Line::spirv numbers them from 1
  // These are the bytes of variables and payloads. Spills and saved values are placed after them.
  uint32_t local_bytes = 0;
  uint32_t function = 0;  // isa::Program::function
  uint32_t payload_bytes = 0, attribute_bytes = 0;
  std::array<uint32_t, 3> local_size{1, 1, 1};
  uint32_t shared_bytes = 0;          // bytes per block of threads
  std::vector<std::string> messages;  // formats of print and print.part

  VirtualRegister new_register(RegisterClass c) {
    registers.push_back(c);
    return VirtualRegister(registers.size() - 1);
  }
};

// Schedules each block for latency, allocates registers (graph colouring, with spills to local memory), saves
// and restores live values around calls, lays out the code and resolves labels.
struct BackendOptions;
isa::Program assemble(VirtualProgram program, const BackendOptions& options);

}  // namespace glint::frontend
