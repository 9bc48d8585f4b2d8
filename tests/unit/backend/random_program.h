// Makes random structured programs over virtual registers: every op without effects, memory, branches, loops,
// calls.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "frontend/virtual_program.h"

namespace glint::frontend::test {

struct Shape {
  int statements = 40;
  int values = 12;  // initial values of each class; they decide how much is live
  bool control = true, calls = true, memory = true;
  bool wide_traces = false;  // rt.trace has all operands in registers; not for few registers
};

class RandomProgram {
 public:
  RandomProgram(uint32_t seed, const Shape& shape) : random_(seed), shape_(shape) {
    program_.name = "random";
    program_.stage = isa::Stage::RayGeneration;
    program_.local_bytes = kVariables;
    open("entry");
    for (const isa::OpRow& row : isa::op_table())
      if (is_plain(row)) plain_.push_back(isa::op_index(row.name));
    for (int i = 0; i < shape.values; ++i) define_inputs();
    statements(shape.statements, 0);
    for (const auto& pool : pools_)
      for (VirtualRegister r : pool) store(r);
    add("exit", {});
  }
  VirtualProgram take() { return std::move(program_); }

 private:
  using Operand = VirtualOperand;
  static constexpr uint32_t kVariables = 48;  // bytes of local variables

  uint32_t pick(size_t n) { return uint32_t(random_() % n); }
  static bool is_plain(const isa::OpRow& row) {
    if (row.effect != isa::Effect::None || row.operands.count == 0) return false;
    if (isa::depends_on_lanes(row)) return false;
    for (isa::OperandKind kind : row.operands.view())
      if (kind >= isa::OperandKind::Address64 || kind == isa::OperandKind::None) return false;
    return isa::is_destination(row.operands.kind[0]);
  }

  BlockId open(const std::string& name) {
    program_.blocks.push_back({name, {}, {}});
    return current_ = BlockId(program_.blocks.size() - 1);
  }
  // Blocks are numbered in layout order, so the targets of forward branches are set when their blocks are
  // opened.
  VirtualInst& add_op(uint16_t op, std::vector<Operand> operands, int32_t imm = 0) {
    VirtualInst inst;
    inst.op = op;
    inst.operands = std::move(operands);
    inst.imm = imm;
    program_.blocks[current_].code.push_back(inst);
    return program_.blocks[current_].code.back();
  }
  VirtualInst& add(const char* name, std::vector<Operand> operands, int32_t imm = 0) {
    return add_op(isa::op_index(name), std::move(operands), imm);
  }
  VirtualInst& marker(VirtualInst::Kind kind) {
    VirtualInst inst;
    inst.kind = kind;
    program_.blocks[current_].code.push_back(inst);
    return program_.blocks[current_].code.back();
  }

  std::vector<VirtualRegister>& pool(RegisterClass c) { return pools_[size_t(c)]; }
  VirtualRegister any(RegisterClass c) { return pool(c)[pick(pool(c).size())]; }
  VirtualRegister destination(RegisterClass c) {
    if (pick(3) == 0) return any(c);
    const VirtualRegister r = program_.new_register(c);
    fresh_.push_back(r);
    return r;
  }
  void publish_fresh() {
    for (VirtualRegister r : fresh_) pool(program_.registers[r]).push_back(r);
    fresh_.clear();
  }

  Operand source(isa::OperandKind kind) {
    if (kind == isa::OperandKind::SrcPred) return Operand::of(any(RegisterClass::Predicate));
    const bool wide = kind == isa::OperandKind::Src64;
    if (pick(4) == 0)
      return Operand::value(wide ? uint64_t{random_()} << pick(33) : pick(2) ? pick(34) : random_());
    if (!wide && pick(12) == 0) return Operand::of(isa::Special(1 + pick(3)));
    return Operand::of(any(wide ? RegisterClass::B64 : RegisterClass::B32));
  }

  void define_inputs() {
    const VirtualRegister word = program_.new_register(RegisterClass::B32),
                          pair = program_.new_register(RegisterClass::B64);
    const VirtualRegister flag = program_.new_register(RegisterClass::Predicate);
    const VirtualRegister address = program_.new_register(RegisterClass::B64);
    add("mad.wide.u32", {Operand::of(address), Operand::of(isa::Special::LaunchX), Operand::value(64),
                         Operand::value(0x10000 + 8 * pick(64))});
    add("ld.global.b32", {Operand::of(word), Operand::of(address)}, 4);
    add("ld.global.b64", {Operand::of(pair), Operand::of(address)}, 8);
    add("setp.lt.s32", {Operand::of(flag), Operand::of(word), Operand::value(pick(2) ? 0 : 0x40000000)});
    pool(RegisterClass::B32).push_back(word);
    pool(RegisterClass::B64).push_back(pair);
    pool(RegisterClass::Predicate).push_back(flag);
  }

  void store(VirtualRegister r) {
    const VirtualRegister address = program_.new_register(RegisterClass::B64);
    add("mov.b64", {Operand::of(address), Operand::value(0x20000 + 8 * uint64_t{r})});
    if (program_.registers[r] == RegisterClass::B64) {
      add("st.global.b64", {Operand::of(address), Operand::of(r)});
    } else if (program_.registers[r] == RegisterClass::B32) {
      add("st.global.b32", {Operand::of(address), Operand::of(r)});
    } else {
      const VirtualRegister word = program_.new_register(RegisterClass::B32);
      add("selp.b32", {Operand::of(word), Operand::value(3), Operand::value(5), Operand::of(r)});
      add("st.global.b32", {Operand::of(address), Operand::of(word)});
    }
  }

  void statements(int count, int depth) {
    for (int i = 0; i < count; ++i) {
      const uint32_t choice = pick(20);
      if (choice == 0 && shape_.control && depth < 3)
        selection(depth);
      else if (choice == 1 && shape_.control && depth < 2)
        loop(depth);
      else if (choice == 2 && shape_.calls)
        call();
      else if (choice == 3 && shape_.calls)
        trace();
      else if (choice <= 6 && shape_.memory)
        memory();
      else if (choice <= 11)
        familiar();
      else
        plain();
    }
  }

  void plain() {
    const uint16_t op = plain_[pick(plain_.size())];
    add_with_operands(op);
  }

  // Emits the ops that the backend knows by name, which are too rare among random ops.
  void familiar() {
    static constexpr const char* kNames[] = {
        "mov.b32",      "mov.b64",      "mov.pred", "not.pred", "pack.b64",    "unpack.b64", "cvt.u32.u64",
        "cvt.u64.u32",  "cvt.s64.s32",  "selp.b32", "selp.b64", "add.u32",     "add.u64",    "mul.lo.u32",
        "mul.wide.u32", "mul.wide.s32", "shl.b32",  "shl.b64",  "setp.ne.u32", "add.s32"};
    add_with_operands(isa::op_index(kNames[pick(std::size(kNames))]));
  }

  void add_with_operands(uint16_t op) {
    std::vector<Operand> operands;
    for (isa::OperandKind kind : isa::op_table()[op].operands.view())
      for (int i = 0; i < isa::slots_of(kind); ++i) {
        if (kind == isa::OperandKind::Dst64)
          operands.push_back(Operand::of(another(RegisterClass::B64, operands)));
        else if (kind == isa::OperandKind::DstPred)
          operands.push_back(Operand::of(another(RegisterClass::Predicate, operands)));
        else if (isa::is_destination(kind))
          operands.push_back(Operand::of(another(RegisterClass::B32, operands)));
        else
          operands.push_back(source(kind));
      }
    const bool defines_fresh = !fresh_.empty();
    VirtualInst& inst = add_op(op, std::move(operands));
    if (!defines_fresh && pick(3) == 0) {  // a guarded write of an existing value
      inst.guard = any(RegisterClass::Predicate);
      inst.guard_negate = pick(2);
    }
    publish_fresh();
  }
  // Returns a register that is not yet a destination of the instruction.
  VirtualRegister another(RegisterClass c, const std::vector<Operand>& so_far) {
    for (;;) {
      const VirtualRegister r = destination(c);
      bool twice = false;
      for (const Operand& o : so_far) twice |= o.reg == r;
      if (!twice) return r;
    }
  }

  void memory() {
    const bool local = pick(2);
    static constexpr const char* kLocal[] = {"ld.local.b32",    "ld.local.v2.b32", "ld.local.v4.b32",
                                             "ld.local.b64",    "st.local.b32",    "st.local.v2.b32",
                                             "st.local.v4.b32", "st.local.b64"};
    static constexpr const char* kGlobal[] = {"ld.global.b32",    "ld.global.v2.b32", "ld.global.v4.b32",
                                              "ld.global.b64",    "st.global.b32",    "st.global.v2.b32",
                                              "st.global.v4.b32", "st.global.b64"};
    const uint16_t op = isa::op_index(local ? kLocal[pick(8)] : kGlobal[pick(8)]);
    const int32_t imm = int32_t(pick(3) * 16);
    const Operand base = local ? local_base() : global_base();
    std::vector<Operand> operands;
    for (isa::OperandKind kind : isa::op_table()[op].operands.view())
      for (int i = 0; i < isa::slots_of(kind); ++i) {
        if (kind == isa::OperandKind::Address32 || kind == isa::OperandKind::Address64)
          operands.push_back(base);
        else if (kind == isa::OperandKind::Dst64)
          operands.push_back(Operand::of(destination(RegisterClass::B64)));
        else if (isa::is_destination(kind))
          operands.push_back(Operand::of(another(RegisterClass::B32, operands)));
        else if (kind == isa::OperandKind::Src64)
          operands.push_back(source(kind));
        else
          operands.push_back(source(isa::OperandKind::Src32));
      }
    add_op(op, std::move(operands), local ? imm % int32_t(kVariables - 15) : imm);
    publish_fresh();
  }
  Operand local_base() {
    if (pick(2)) return Operand::stack_pointer();
    const VirtualRegister base = program_.new_register(RegisterClass::B32);
    add("add.u32", {Operand::of(base), Operand::stack_pointer(), Operand::value(0)});
    return Operand::of(base);
  }
  Operand global_base() {
    const VirtualRegister index = program_.new_register(RegisterClass::B32),
                          base = program_.new_register(RegisterClass::B64);
    add("and.b32", {Operand::of(index), Operand::of(any(RegisterClass::B32)), Operand::value(0x70)});
    add(pick(2) ? "mad.wide.u32" : "mad.wide.s32",
        {Operand::of(base), Operand::of(index), Operand::value(1), Operand::value(0x30000)});
    const VirtualRegister sum = program_.new_register(RegisterClass::B64);
    add("add.u64", {Operand::of(sum), Operand::of(base), Operand::value(16 * pick(3))});
    return Operand::of(sum);
  }

  void selection(int depth) {
    const VirtualRegister condition = any(RegisterClass::Predicate);
    const BlockId head = current_;
    add("ssy", {});
    add("bra", {}).guard = condition;
    const size_t ssy = program_.blocks[head].code.size() - 2;
    const bool has_else = pick(2);
    const auto scope = pools_;
    const BlockId first = open("then");
    program_.blocks[head].successors = {first};
    statements(1 + int(pick(6)), depth + 1);
    const BlockId first_end = current_;
    pools_ = scope;
    add("bra", {});
    BlockId second = kNoBlock, second_end = kNoBlock;
    if (has_else) {
      second = open("else");
      statements(1 + int(pick(6)), depth + 1);
      second_end = current_;
      pools_ = scope;
    }
    const BlockId merge = open("merge");
    add("join", {});
    VirtualInst& branch = program_.blocks[head].code[ssy + 1];
    branch.guard_negate = pick(2);
    branch.target = has_else ? second : merge;
    program_.blocks[head].code[ssy].target = merge;
    program_.blocks[head].successors.push_back(branch.target);
    program_.blocks[first_end].code.back().target = merge;
    program_.blocks[first_end].successors = {merge};
    if (has_else) program_.blocks[second_end].successors = {merge};
  }

  void loop(int depth) {
    const VirtualRegister counter = program_.new_register(RegisterClass::B32),
                          more = program_.new_register(RegisterClass::Predicate);
    add("mov.b32", {Operand::of(counter), Operand::value(1 + pick(3))});
    add("ssy", {});
    const BlockId before = current_;
    const auto scope = pools_;
    const BlockId head = open("loop");
    program_.blocks[before].successors = {head};
    add("setp.ne.u32", {Operand::of(more), Operand::of(counter), Operand::value(0)});
    VirtualInst& leave = add("bra", {});
    leave.guard = more;
    leave.guard_negate = true;
    const BlockId body = open("body");
    statements(2 + int(pick(8)), depth + 1);
    add("sub.u32", {Operand::of(counter), Operand::of(counter), Operand::value(1)});
    add("bra", {}).target = head;
    program_.blocks[current_].successors = {head};
    pools_ = scope;
    const BlockId done = open("done");
    add("join", {});
    program_.blocks[before].code.back().target = done;
    program_.blocks[head].code.back().target = done;
    program_.blocks[head].successors = {body, done};
  }

  // Emits a trace that never needs a shader.
  void call() {
    std::vector<Operand> operands{Operand::of(program_.new_register(RegisterClass::Predicate)),
                                  Operand::of(any(RegisterClass::B64))};
    for (int i = 0; i < 15; ++i) operands.push_back(Operand::value(pick(99)));
    marker(VirtualInst::Kind::SaveLive);
    add("rt.trace", std::move(operands));
    add("call.sbt.hit", {});
    add("rt.end", {});
    marker(VirtualInst::Kind::RestoreLive);
  }

  // Emits a trace as docs/abi.md, "Calls and rays", defines it.
  void trace() {
    const VirtualRegister waits = program_.new_register(RegisterClass::Predicate);
    std::vector<Operand> operands{Operand::of(waits)};
    operands.push_back(Operand::of(any(RegisterClass::B64)));
    for (int i = 0; i < 15; ++i)
      operands.push_back(shape_.wide_traces ? source(isa::OperandKind::Src32)
                         : i == 7           ? Operand::of(any(RegisterClass::B32))
                                            : Operand::value(pick(99)));
    marker(VirtualInst::Kind::SaveLive);
    add("rt.trace", std::move(operands));
    add("ssy", {});
    const BlockId before = current_;
    const BlockId head = open("rays");
    add("bra", {}).guard = waits;
    program_.blocks[head].code.back().guard_negate = true;
    const BlockId body = open("candidate");
    add("call.sbt.candidate", {});
    add("rt.resume", {Operand::of(waits)});
    add("bra", {}).target = head;
    const BlockId done = open("traced");
    add("join", {});
    add("call.sbt.hit", {});
    add("rt.end", {});
    marker(VirtualInst::Kind::RestoreLive);
    program_.blocks[before].code.back().target = done;
    program_.blocks[before].successors = {head};
    program_.blocks[head].code.back().target = done;
    program_.blocks[head].successors = {body, done};
    program_.blocks[body].successors = {head};
  }

  std::mt19937 random_;
  Shape shape_;
  VirtualProgram program_;
  std::vector<uint16_t> plain_;
  // By RegisterClass: registers that every path to this point has defined.
  std::array<std::vector<VirtualRegister>, 3> pools_;
  std::vector<VirtualRegister> fresh_;
  BlockId current_ = 0;
};

}  // namespace glint::frontend::test
