// Tells which virtual registers are live where, and the other facts about control flow that the backend
// needs.
//
// The analysis treats each lane as a thread of its own. An op writes only the lanes that execute it, so the
// values of waiting lanes stay in their registers whatever the other lanes do, and liveness along each lane's
// path suffices.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "frontend/virtual_program.h"

namespace glint::frontend {

// Holds a set of virtual registers, with one bit for each.
class RegisterSet {
 public:
  RegisterSet() = default;
  explicit RegisterSet(size_t registers) : words_((registers + 63) / 64) {}

  bool contains(VirtualRegister r) const { return (words_[r / 64] >> (r % 64)) & 1; }
  void insert(VirtualRegister r) { words_[r / 64] |= uint64_t{1} << (r % 64); }
  void erase(VirtualRegister r) { words_[r / 64] &= ~(uint64_t{1} << (r % 64)); }
  bool unite(const RegisterSet& other);  // returns true when the set grew
  void intersect(const RegisterSet& other);
  size_t size() const;

  // Calls visit(register) in ascending order.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (size_t w = 0; w < words_.size(); ++w)
      for (uint64_t bits = words_[w]; bits; bits &= bits - 1)
        visit(VirtualRegister(w * 64 + size_t(std::countr_zero(bits))));
  }

 private:
  std::vector<uint64_t> words_;
};

struct Liveness {
  std::vector<RegisterSet> in, out;  // one set for each block
};

Liveness find_liveness(const VirtualProgram& program);

// Walks a block backwards and keeps the set of registers that are live before the instructions it has passed.
//
// A guarded write does not end the old value, because lanes whose guard is false keep it. It does end the old
// value if those lanes never read it: every later read is under the same guard, or a write under the opposite
// guard follows.
class LiveWalk {
 public:
  explicit LiveWalk(RegisterSet live_out) : live_(std::move(live_out)) {}
  void step(const VirtualInst& inst);
  const RegisterSet& live() const { return live_; }

 private:
  // Names a live register whose present value is read only by lanes with this guard.
  struct Conditional {
    VirtualRegister reg, guard;
    bool negate;
  };
  bool is_conditional(VirtualRegister r) const;
  bool is_conditional(VirtualRegister r, const VirtualInst& inst) const;
  void forget(VirtualRegister r);

  RegisterSet live_;
  std::vector<Conditional> conditional_;
};

// Estimates how often each block runs: 8 times its surroundings for each loop around it, capped at 8^4.
// Choice: a backward branch in layout order makes a loop of everything between its ends.
std::vector<float> block_weights(const VirtualProgram& program);

// Returns for each block whether control enters it between a SaveLive and its RestoreLive. It is a bug in
// Glint if paths disagree.
std::vector<bool> enters_in_region(const VirtualProgram& program);

// Names an instruction of the program.
struct ProgramPoint {
  BlockId block = kNoBlock;
  size_t index = 0;
  bool operator==(const ProgramPoint&) const = default;
};

// Holds a SaveLive, its RestoreLive, and the registers that must survive between them because they are live
// after both.
struct CallRegion {
  ProgramPoint save, restore;
  RegisterSet live;
};
std::vector<CallRegion> find_call_regions(const VirtualProgram& program, const Liveness& liveness);

}  // namespace glint::frontend
