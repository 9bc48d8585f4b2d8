// Writes virtual instructions block by block: it picks destination registers, folds constants and reuses
// values.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "frontend/virtual_program.h"

namespace glint::frontend {

using Operand = VirtualOperand;
using Operands = std::vector<Operand>;

inline Operand word(uint32_t bits) {
  return Operand::value(bits);
}
inline Operand constant_f32(float value) {
  return Operand::value(std::bit_cast<uint32_t>(value));
}
bool is_constant(const Operand& operand, uint64_t bits);
bool same(const Operand& a, const Operand& b);

// Holds the result of a pure op over constants or by an identity (x + 0, x * 8 = x << 3, ...) that gives the
// same bits for every x. `folded` is false when no rule applies. A predicate result may be the constant 0 or
// 1.
struct Folded {
  bool folded = false;
  Operand operand;
};
Folded fold(std::string_view op, const Operands& sources);

class Emitter {
 public:
  // Holds values computed earlier that may be used again. They are valid in the blocks that the computing
  // block dominates.
  using Known = std::map<std::vector<uint64_t>, Operands>;

  explicit Emitter(VirtualProgram& program) : program_(program) {}

  // --- Blocks. place() puts a block next in the layout. An open block before it falls through into it.
  BlockId new_block(std::string name);
  void place(BlockId block);
  BlockId here() const { return here_; }
  bool is_open() const { return open_; }
  void set_line(isa::Line line) {
    if (line.line == 0) line.file = line_.file, line.line = line_.line;
    line_ = line;
  }
  isa::Line line() const { return line_; }
  // Renumbers the blocks into layout order, and drops blocks that were never placed and branches to the next
  // block.
  void finish();

  // --- Values. The destination's class follows from the op's row.
  Operand value(std::string_view op, Operands sources);
  // Does the same as value() for ops whose result changes from one execution to the next. It never folds or
  // reuses.
  Operand fresh(std::string_view op, Operands sources);
  // Loads `count` parts. A load is reused while `version` is the same; version 0 is never reused.
  Operands load(std::string_view op, const Operand& base, int32_t displacement, int count, uint64_t version);
  // Notes that the 32-bit load `op` would give `word`, because that word was just loaded or stored there.
  void remember(std::string_view op, const Operand& base, int32_t displacement, uint64_t version,
                const Operand& word);
  // Returns the operand as a register, with a move when it is not one.
  Operand in_register(const Operand& operand, RegisterClass c);
  void copy(VirtualRegister to, RegisterClass c, const Operand& from);

  // --- Effects and control. A guard is a Predicate register.
  VirtualInst& effect(std::string_view op, Operands operands, int32_t displacement = 0);
  void marker(VirtualInst::Kind kind);
  void push_reconvergence(BlockId at);                              // emits ssy
  void branch(BlockId to);                                          // ends the block
  void branch_if(const Operand& predicate, bool when, BlockId to);  // does not end the block
  void end(std::string_view op);                                    // op: exit, ret, rt.ignore, rt.terminate

  // --- Shorthand for the most frequent ops.
  Operand add(Operand a, Operand b) { return value("add.rn.f32", {a, b}); }
  Operand sub(Operand a, Operand b) { return value("sub.rn.f32", {a, b}); }
  Operand mul(Operand a, Operand b) { return value("mul.rn.f32", {a, b}); }
  Operand div(Operand a, Operand b) { return value("div.rn.f32", {a, b}); }
  Operand fma(Operand a, Operand b, Operand c) { return value("fma.rn.f32", {a, b, c}); }
  Operand select(Operand predicate, Operand a, Operand b);  // of any class; a and b give the class
  RegisterClass class_of(const Operand& operand, RegisterClass of_constant = RegisterClass::B32) const;
  Operand select_bool(Operand predicate, Operand a, Operand b);

  // Says whether results of arithmetic may, from now on, be fused with the ops that use them.
  void set_free(bool free) { free_ = free; }
  const std::set<VirtualRegister>& free_results() const { return free_results_; }

  const Known& known() const { return known_; }
  void set_known(Known known) { known_ = std::move(known); }
  void forget() { known_.clear(); }

 private:
  VirtualInst& append(std::string_view op, Operands operands, int32_t displacement);
  void add_successor(BlockId to);

  VirtualProgram& program_;
  std::vector<BlockId> layout_;
  BlockId here_ = kNoBlock;
  bool open_ = false;
  isa::Line line_;
  Known known_;
  bool free_ = false;
  std::set<VirtualRegister> free_results_;
  std::map<VirtualRegister, VirtualRegister> negation_of_;  // sources of not.pred, by result
};

}  // namespace glint::frontend
