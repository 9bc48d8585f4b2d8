// Tells which virtual registers are live where, and the other facts about control flow that the backend
// needs.
//
// The analysis treats each lane as a thread of its own. An op writes only the lanes that execute it, so the
// values of waiting lanes stay in their registers whatever the other lanes do, and liveness along each lane's
// path suffices.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "frontend/backend/register_set.h"
#include "frontend/virtual_program.h"

namespace glint::frontend {

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
// Does the same, and finds the liveness itself if there are calls.
std::vector<CallRegion> find_call_regions(const VirtualProgram& program);

}  // namespace glint::frontend
