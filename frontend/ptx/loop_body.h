// Copies the body of a loop of one block, turn by turn, with registers of the copies' own.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "frontend/backend/slots.h"
#include "frontend/ptx/constant_words.h"
#include "frontend/ptx/draft.h"

namespace glint::frontend::ptx {

// Knows which registers a loop writes, keeps and steps, and makes copies of its turns. The last instruction
// of the loop's block is the test that ends the loop; copies leave it out.
class LoopBody {
 public:
  LoopBody(Draft& draft, VirtualProgram& program, BlockId at);

  // Returns true for registers that the loop writes.
  bool writes(VirtualRegister r) const { return definitions_.contains(r); }
  bool writes_once(VirtualRegister r) const { return writes(r) && definitions_.at(r) == 1; }
  // Returns true for registers that the next turn or another block reads.
  bool keeps(VirtualRegister r) const { return kept_.contains(r); }
  // Returns what a turn adds to a register that nothing else in the loop changes.
  std::optional<int64_t> step(VirtualRegister r) const;

  // Begins a row of copies whose first turn begins with what the registers hold then.
  void begin_copies();
  // Says that a stepping register holds this value when the first turn begins. `code` gets what copies need
  // for it. It is called after begin_copies().
  void starts_with(VirtualRegister r, uint64_t value, std::vector<VirtualInst>& code);
  // Appends the turn with this number, counted from 0. The last one writes the registers that are kept.
  void copy(int64_t turn, bool last, std::vector<VirtualInst>& code);
  // Returns the name that the result of the block's instruction `i` has in the turn with the number 0.
  VirtualOperand first_result(size_t i) const { return first_.at(i); }

 private:
  const DraftBlock& block() const { return draft_.blocks[at_]; }
  bool is_wide(VirtualRegister r) const { return program_.registers[r] == RegisterClass::B64; }
  std::optional<int64_t> step_of(const VirtualInst& inst) const;
  // Returns the move of a constant to a register of any width.
  VirtualInst constant_move(VirtualRegister to, uint64_t value, const isa::Line& line) const;
  void find_kept();
  VirtualOperand now(const VirtualOperand& o) const;
  bool take_from_first(VirtualInst& inst, int64_t turn, size_t i) const;
  bool is_behind(size_t i, VirtualRegister r) const;
  void name_results(VirtualInst& inst, bool last);

  Draft& draft_;
  VirtualProgram& program_;
  const BlockId at_;
  const Ops ops_;
  const ConstantWords constants_;
  std::map<VirtualRegister, int> definitions_;  // number of definitions in the loop, by register
  std::set<VirtualRegister> kept_;
  std::map<VirtualRegister, int64_t> steps_;          // constant that a turn adds
  std::map<VirtualRegister, int64_t> stepped_;        // turns that the copies so far have done
  std::map<VirtualRegister, VirtualRegister> names_;  // present name in the copies
  std::map<VirtualRegister, uint64_t> values_;        // what a name of the copies is known to hold
  std::map<VirtualRegister, uint64_t> starts_;        // what a stepping register holds at first, where known
  std::map<size_t, VirtualOperand> first_;            // result of each instruction in the first turn
};

}  // namespace glint::frontend::ptx
