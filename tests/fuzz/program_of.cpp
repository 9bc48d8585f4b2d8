// Makes a program from bytes. Any byte string gives a program, and many of these programs are nearly sound.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string_view>

#include "isa/op_row.h"
#include "tests/fuzz/entry.h"

namespace glint::fuzz {
namespace {

using namespace isa;

constexpr size_t kMaxInstructions = 200;

class Bytes {
 public:
  explicit Bytes(std::span<const uint8_t> bytes) : bytes_(bytes) {}
  bool empty() const { return at_ >= bytes_.size(); }
  uint32_t byte() { return empty() ? 0 : bytes_[at_++]; }
  uint32_t half() {
    const uint32_t low = byte();
    return low | byte() << 8;
  }
  uint32_t word() {
    const uint32_t low = half();
    return low | half() << 16;
  }

 private:
  std::span<const uint8_t> bytes_;
  size_t at_ = 0;
};

// An eighth of all op numbers select one of these ops, which make paths, regions and calls.
constexpr std::string_view kSteering[] = {"bra",           "ssy",           "join",
                                          "exit",          "ret",           "rt.trace",
                                          "rt.end",        "rt.resume",     "call.sbt.candidate",
                                          "call.sbt.hit",  "setp.eq.u32",   "mov.b32",
                                          "ld.global.b32", "st.global.b32", "ld.local.b32",
                                          "st.local.b32"};

uint16_t some_op(Bytes& in) {
  const uint32_t n = in.half();
  if (n >= 0xe000)
    if (const int op = find_op(kSteering[n % std::size(kSteering)]); op >= 0) return uint16_t(op);
  return uint16_t(n % op_table().size());
}

Slot some_slot(Bytes& in, const Program& p, OperandKind kind) {
  const uint32_t n = in.byte();
  if (kind == OperandKind::DstPred || kind == OperandKind::SrcPred)
    return Slot(n % (kNumPredicates + (n == 255)));
  const bool is_wide =
      kind == OperandKind::Dst64 || kind == OperandKind::Src64 || kind == OperandKind::Address64;
  if (n < 128 || (is_destination(kind) && n < 250))
    return Slot(is_wide ? n % p.num_registers & ~1u : n % p.num_registers);
  if (n < 192 && !p.constants.empty()) return Slot(kConstantBank + n % p.constants.size());
  if (n < 250) return Slot(kSpecialBank + (n - 128) % kNumSpecials);
  return Slot(in.half());
}

Inst some_inst(Bytes& in, const Program& p) {
  Inst inst;
  inst.op = some_op(in);
  const uint32_t guard = in.byte();
  if (guard >= 128) inst.guard = uint8_t((guard & 7) | (guard & 64 ? kGuardNegate : 0));
  int slot = 0;
  for (const OperandKind kind : op_table()[inst.op].operands.view()) {
    for (const int end = slot + slots_of(kind); slot < end; ++slot)
      inst.operand[size_t(slot)] = some_slot(in, p, kind);
    if (kind == OperandKind::Label) inst.imm = int32_t(p.code.size()) + int8_t(in.byte());
    if (kind == OperandKind::Address32 || kind == OperandKind::Address64) {
      const uint32_t n = in.byte();
      inst.imm = n == 255 ? int32_t(in.word()) : int32_t(n) - 32;
    }
  }
  return inst;
}

void add(Program& p, std::string_view op, std::array<Slot, 3> operands) {
  Inst inst;
  inst.op = op_index(op);
  for (size_t i = 0; i < operands.size(); ++i) inst.operand[i] = operands[i];
  p.code.push_back(inst);
}

// Writes all registers and predicates, with values that differ from lane to lane.
void write_everything(Program& p) {
  for (Slot r = 1; r < p.num_registers; ++r) add(p, "mov.b32", {r, Slot(kSpecialBank + r % 7u)});
  for (Slot q = 0; q < kNumPredicates; ++q) add(p, "setp.lt.u32", {q, kSpecialBank, Slot(kConstantBank + q)});
}

}  // namespace

Program program_of(std::span<const uint8_t> bytes) {
  Bytes in(bytes);
  Program p;
  p.name = "bytes";
  p.stage = Stage(in.byte() % uint32_t(kNumStages));
  p.num_registers = 8 + in.byte() % 40;
  p.local_bytes = in.byte() * 4;
  p.shared_bytes = in.byte() * 4;
  const uint32_t flags = in.byte();
  for (uint32_t q = 0; q < uint32_t(kNumPredicates); ++q) p.constants.push_back(4 * q + 1);
  for (uint32_t n = in.byte() % 16; n > 0; --n) p.constants.push_back(in.word());
  if (flags & 1) write_everything(p);
  while (!in.empty() && p.code.size() < kMaxInstructions) p.code.push_back(some_inst(in, p));
  const bool is_entry = p.stage == Stage::RayGeneration || p.stage == Stage::Compute;
  if (flags & 2) add(p, is_entry ? "exit" : "ret", {});
  p.lines.resize(p.code.size());
  return p;
}

}  // namespace glint::fuzz
