// One row of the ISA table: everything the emulator, its docs and its tests know of one op.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>

#include "isa/image_access.h"
#include "isa/inst.h"
#include "isa/warp.h"

namespace glint::isa {

// Instruction-mix class, as the LumiBench paper's Figure 8 splits instructions.
enum class Class : uint8_t { Alu, Sfu, Mem, Tex, Ctrl, Rt, Count };
constexpr std::string_view name_of(Class c) {
  constexpr std::string_view kNames[] = {"alu", "sfu", "mem", "tex", "ctrl", "rt"};
  return kNames[size_t(c)];
}

// Execution unit: latency and initiation interval come from the configuration, `[core.units.<name>]`.
// FpDiv and IntDiv are multi-pass sequences that the hardware runs on the named pipe.
enum class Unit : uint8_t {
  Int,
  IntDiv,
  Fp32,
  FpDiv,
  Fp64,
  Fp64Div,
  Fp16,
  Sfu,
  Move,
  Predicate,
  Shuffle,  // lanes that read each other: shfl, vote, match, redux
  Lsu,
  Const,
  Tex,
  Branch,
  Barrier,  // bar.*, membar.*
  RtUnit,
  Count
};
constexpr std::string_view name_of(Unit u) {
  constexpr std::string_view kNames[] = {"int",   "int_div", "fp32",   "fp_div",    "fp64",    "fp64_div",
                                         "fp16",  "sfu",     "move",   "predicate", "shuffle", "lsu",
                                         "const", "tex",     "branch", "barrier",   "rt_unit"};
  return kNames[size_t(u)];
}

// Kinds of operand, in the order in which the text writes them. Each takes one slot unless noted.
enum class OperandKind : uint8_t {
  None,
  Dst32,
  Dst64,
  DstPred,
  Src32,
  Src64,
  SrcPred,  // Src32/Src64: register, constant (written as a number) or special
  DstVec2,
  DstVec4,
  SrcVec2,
  SrcVec4,    // "{%r1, %r2}": 2 or 4 slots of any 32-bit registers
  Address64,  // "[%rd4 + 16]": pair and byte displacement (Inst::imm)
  Address32,  // "[%r4 + 16]": register or constant 0 ("[16]"), and displacement: local, shared, const
  Label,      // Inst::imm = target instruction index; no slot
};
constexpr int slots_of(OperandKind k) {
  switch (k) {
    case OperandKind::None:
    case OperandKind::Label:
      return 0;
    case OperandKind::DstVec2:
    case OperandKind::SrcVec2:
      return 2;
    case OperandKind::DstVec4:
    case OperandKind::SrcVec4:
      return 4;
    case OperandKind::Dst32:
    case OperandKind::Dst64:
    case OperandKind::DstPred:
    case OperandKind::Src32:
    case OperandKind::Src64:
    case OperandKind::SrcPred:
    case OperandKind::Address64:
    case OperandKind::Address32:
      return 1;
  }
  return 0;
}
constexpr bool is_destination(OperandKind k) {
  return k == OperandKind::Dst32 || k == OperandKind::Dst64 || k == OperandKind::DstPred ||
         k == OperandKind::DstVec2 || k == OperandKind::DstVec4;
}

struct Operands {
  std::array<OperandKind, kMaxOperands> kind{};
  uint8_t count = 0;
  constexpr Operands() = default;
  constexpr Operands(std::initializer_list<OperandKind> list) {
    for (OperandKind k : list) kind[count++] = k;
  }
  constexpr std::span<const OperandKind> view() const { return {kind.data(), count}; }
};

// What the machine must do after the handler ran. None: the handler wrote its registers and that is all.
enum class Effect : uint8_t {
  None,
  Load,
  Store,
  Atomic,   // OpRow::memory says how; addresses in Warp::access
  Texture,  // OpRow::image says how; access.address = texture handle
  SurfaceLoad,
  SurfaceStore,       // as Texture; access.address = image handle
  SurfaceAtomic,      // read-modify-write of a texel by OpRow::atomic
  ImageQuery,         // what the image is like: no memory access
  Branch,             // to Inst::imm for the lanes of exec
  BranchIndexed,      // brx.idx: to Inst::imm + operand 0, where a table of branches stands
  Call,               // to the function at Inst::imm; `ret` comes back
  PushReconvergence,  // ssy: lanes will meet at Inst::imm
  Join,               // lanes wait here for the others of the innermost ssy that names this place
  Exit,               // lanes end
  Return,             // lanes return from a function or a shader call
  Trap,               // a fault
  CallCandidate,
  CallAnyHit,
  CallHit,
  CallCallable,  // call.sbt.*: indirect shader calls through the binding table
  Trace,
  Resume,  // rt.trace, rt.resume: give rays to the RT unit; answer: predicate slot 0
  Report,
  Accepted,
  Ignore,
  Terminate,
  EndTrace,  // rt.report, rt.accepted, rt.ignore, rt.terminate, rt.end
  Query,
  QueryProceed,  // rq.*: OpRow::detail says which; rq.proceed gives rays to the RT unit
  HitObject,     // ho.*: OpRow::detail says which (isa/hit_object.h)
  Barrier,       // bar.*: warps of a block wait for each other
  Print,
  PrintPart,  // print, print.part: a message of Program::messages with the words of its conversions
  Fence,      // membar, fence, bar.warp.sync: orders memory accesses of the warp
};

// Runs other shaders, which use all registers and predicates but %r0 (docs/abi.md).
constexpr bool is_shader_call(Effect e) {
  return e == Effect::CallCandidate || e == Effect::CallAnyHit || e == Effect::CallHit ||
         e == Effect::CallCallable;
}

// Generic: a 64-bit address whose window says which of global, shared and local it is in
// (isa/generic_address.h). Param: the parameters of a kernel; they lie in the constant bank at
// kPushConstantOffset (isa/program.h).
enum class Space : uint8_t { None, Global, Local, Shared, Const, Param, Generic };

// Static shape of a load or store: `count` parts of `bytes` bytes, consecutive in memory; a part of 8
// bytes fills a register pair, parts of 1 and 2 bytes are zero- or sign-extended to 32 bits.
struct Memory {
  Space space = Space::None;
  uint8_t bytes = 4;
  uint8_t count = 1;
  bool sign_extend = false;
};

// Runs one instruction for the lanes of `warp.exec`; lanes outside keep their values.
using Handler = void (*)(Warp& warp, const Inst& inst);

// What an atomic op makes of the old bits in memory and its operands `b` and `c`. An op without a second
// operand gets in `c` whether the place is in global memory, whose adders differ. Runs a lane at a time:
// lanes that meet take turns.
using AtomicFunction = uint64_t (*)(uint64_t old, uint64_t b, uint64_t c);

// Inputs (raw bits, one entry a source operand, predicates 0 or 1) and the expected result bits; `second` is
// that of the second destination, where there is one.
struct Example {
  std::array<uint64_t, 5> in{};
  uint64_t out = 0;
  uint64_t second = 0;
};
struct Examples {
  std::array<Example, 8> at{};
  uint8_t count = 0;
  constexpr Examples() = default;
  constexpr Examples(std::initializer_list<Example> list) {
    for (const Example& e : list) at[count++] = e;
  }
  constexpr std::span<const Example> view() const { return {at.data(), count}; }
};

struct OpRow {
  std::string_view name;  // PTX's spelling, type suffix included: "add.s32"; parser and printer use it
  Class klass = Class::Alu;
  Unit unit = Unit::Int;
  Operands operands;  // what verifier, parser, register allocator and scheduler need
  Effect effect = Effect::None;
  Memory memory;
  ImageAccess image;                // of texture and surface ops
  AtomicFunction atomic = nullptr;  // of Effect::Atomic and SurfaceAtomic
  uint16_t detail = 0;              // which of its family, where one effect serves many rows: isa/ray_query.h
  Handler run = nullptr;            // never null; ops that are all effect have an empty handler
  std::string_view doc;             // one sentence: docs/isa.md and `glint isa add.s32`
  Examples examples;                // documentation and test at once
};

// The whole table, sorted by family then declaration; row index = Inst::op. The handlers are those of the
// widest SIMD path this machine has; every path gives identical bits.
std::span<const OpRow> op_table();

// Index of the row of that name, or -1.
int find_op(std::string_view name);

// As find_op, but an unknown name is our own bug: for code that names ops literally.
uint16_t op_index(std::string_view name);

}  // namespace glint::isa
