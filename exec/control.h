// Runs control flow: branches, calls and returns, regions whose lanes meet again, and ends.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "exec/code_traversal.h"

namespace glint::exec {

class Control {
 public:
  Control(const World& world, FaultGate& faults, ShaderCalls& calls, CodeTraversal& traversal)
      : world_(world), faults_(faults), calls_(calls), traversal_(traversal) {}

  // Returns false after a fault.
  bool run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  // Lets lanes that have parted in waiting loops come together at the instruction `pc` (Step::meets), to
  // which the running ones have come. Returns false when they wait there for others, which run instead.
  bool meet(WarpContext& warp, uint32_t pc);
  // Lets lanes that wait go on when none of the warp's lanes runs.
  void resume_if_empty(WarpContext& warp);

 private:
  bool branch(WarpContext& warp, uint32_t target);
  bool branch_back(WarpContext& warp, uint32_t target);
  static void go_round(WarpContext& warp, uint32_t pc);
  bool branch_indexed(WarpContext& warp, const isa::Inst& inst);
  bool call_function(WarpContext& warp, uint32_t target);
  bool return_from(WarpContext& warp, isa::Effect effect);
  void leave(WarpContext& warp, LaneMask lanes);

  const World& world_;
  FaultGate& faults_;
  ShaderCalls& calls_;
  CodeTraversal& traversal_;
};

}  // namespace glint::exec
