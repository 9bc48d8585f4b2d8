// Defines one row of the ISA table: everything that the emulator, its docs and its tests know of one op.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <span>
#include <string_view>

#include "isa/effects.h"
#include "isa/image_access.h"
#include "isa/inst.h"
#include "isa/units.h"
#include "isa/warp.h"

namespace glint::isa {

// Names the instruction-mix classes by which the LumiBench paper's Figure 8 splits instructions.
enum class Class : uint8_t { Alu, Sfu, Mem, Tex, Ctrl, Rt, Count };
constexpr std::string_view name_of(Class c) {
  constexpr std::string_view kNames[] = {"alu", "sfu", "mem", "tex", "ctrl", "rt"};
  static_assert(std::size(kNames) == size_t(Class::Count));
  return kNames[size_t(c)];
}

// Names the kinds of operands, in the order in which the text writes them. Each takes one slot unless noted.
enum class OperandKind : uint8_t {
  None,
  Dst32,
  Dst64,
  DstPred,
  // Src32 and Src64 are a register, a constant (written as a number) or a special.
  Src32,
  Src64,
  SrcPred,
  // Vectors are written "{%r1, %r2}" and take 2 or 4 slots of any 32-bit registers.
  DstVec2,
  DstVec4,
  SrcVec2,
  SrcVec4,
  Address64,  // "[%rd4 + 16]": pair and byte displacement (Inst::imm)
  // Address32 is "[%r4 + 16]": a register or the constant 0 ("[16]"), and a displacement. It is used for
  // local, shared and constant memory.
  Address32,
  Label,  // Inst::imm is the index of the target instruction; takes no slot
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

// Names the state spaces. Generic is a 64-bit address whose window says whether it is global, shared or local
// (isa/generic_address.h). Param holds the parameters of a kernel, which lie in the constant bank at
// kPushConstantOffset (isa/program.h).
enum class Space : uint8_t { None, Global, Local, Shared, Const, Param, Generic };

// Describes the static shape of a load or store: `count` parts of `bytes` bytes, consecutive in memory. A
// part of 8 bytes fills a register pair. Parts of 1 and 2 bytes are zero- or sign-extended to 32 bits.
struct Memory {
  Space space = Space::None;
  uint8_t bytes = 4;
  uint8_t count = 1;
  bool sign_extend = false;
  // Of ldmatrix and stmatrix: the matrices of 8x8 half words that the warp accesses. Lane 8m + r gives the
  // address of row r of matrix m, and all lanes share out the rows (exec/matrix_accesses.cpp).
  uint8_t matrices = 0;
  bool is_transposed = false;
};

struct OpRow;

// Runs one instruction for the lanes of `warp.exec`. Other lanes keep their values. `row` is the
// instruction's row: a handler of several rows reads there which of them it runs (OpRow::detail).
using Handler = void (*)(Warp& warp, const Inst& inst, const OpRow& row);

// Returns what an atomic op makes of the old bits in memory and its operands `b` and `c`. An op without a
// second operand gets in `c` whether the place is in global memory, whose adders differ. It runs one lane at
// a time, and lanes with the same address take turns.
using AtomicFunction = uint64_t (*)(uint64_t old, uint64_t b, uint64_t c);

// Holds inputs (raw bits, one entry per source operand, predicates as 0 or 1) and the expected result bits.
// `second` is the result of the second destination, if there is one.
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
  std::string_view name;  // PTX's spelling with the type suffix, "add.s32", for parser and printer
  Class klass = Class::Alu;
  Unit unit = Unit::Int;
  Operands operands;  // what verifier, parser, register allocator and scheduler need
  Effect effect = Effect::None;
  Memory memory;
  ImageAccess image;                // of texture and surface ops
  AtomicFunction atomic = nullptr;  // of Effect::Atomic and SurfaceAtomic
  // Says which op of its family a row is, where one effect or one handler serves many rows (isa/ray_query.h).
  uint16_t detail = 0;
  std::string_view reduction;  // of an atomic: the op that does the same and does not give the old value
  Handler run = nullptr;       // never null; an op that is only an effect has an empty handler
  std::string_view doc;        // one sentence, for docs/isa.md and `glint isa add.s32`
  Examples examples;           // examples are documentation and test at once
};

// Returns whether what the op computes depends on the registers of other lanes, or on which lanes execute.
// Such an op may not be given to fewer lanes, nor to more.
constexpr bool depends_on_lanes(const OpRow& row) {
  return row.unit == Unit::Shuffle || row.unit == Unit::Tensor || row.memory.matrices > 0;
}

// Returns the whole table, sorted by family and then by declaration. Inst::op is the index of the row. The
// handlers are those of the widest SIMD path that this machine has; every path gives identical bits.
std::span<const OpRow> op_table();

// Returns the index of the row of that name, or -1.
int find_op(std::string_view name);

// Does the same as find_op(), but an unknown name is a bug in Glint. It serves code that names ops literally.
uint16_t op_index(std::string_view name);

}  // namespace glint::isa
