// Calls other shaders through the binding table, and decides what a called shader decides at its end.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "base/probe.h"
#include "exec/candidates.h"
#include "exec/ray_faults.h"
#include "isa/op_row.h"

namespace glint::exec {

// Holds the lanes of a warp that begin a shader because another called it.
struct Called {
  const WarpContext& warp;
  isa::Stage stage;
  LaneMask lanes;
};

class ShaderCalls {
 public:
  ShaderCalls(const World& world, FaultGate& faults, RayFaults& ray_faults, const Probe<Called>& called,
              CandidateCounts& counts)
      : world_(world), faults_(faults), ray_faults_(ray_faults), called_(called), counts_(counts) {}

  // Calls the shaders or functions that the lanes' rays or their numbers ask for. Returns false after a
  // fault.
  bool run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  // Ends the shader of the lanes with `effect`, and decides what their stage has to decide.
  void finish_shader(WarpContext& warp, isa::Effect effect);

  // Returns the number of lanes that have begun a shader of the stage because another shader called it.
  uint64_t called_lanes(isa::Stage stage) const { return called_lanes_[size_t(stage)]; }
  void count_called(isa::Stage stage, uint64_t lanes) { called_lanes_[size_t(stage)] += lanes; }

 private:
  bool call(WarpContext& warp, isa::Effect effect);
  bool call_callable(WarpContext& warp, const isa::Inst& inst);
  bool call_function(WarpContext& warp, const isa::Inst& inst);
  // Fills `target` with the shader of each calling lane, or kNoShader for a null shader, which is decided
  // here at once.
  bool call_targets(WarpContext& warp, isa::Effect effect, std::array<uint32_t, kLanes>& target);
  void call_nothing(WarpContext& warp, int lane, rt::RayState& state, isa::Effect effect);
  enum class Callee : uint8_t { RayShader, Callable, Function };
  // Returns the number of shaders called.
  uint32_t call_by_shader(WarpContext& warp, const std::array<uint32_t, kLanes>& target, LaneMask callers,
                          Callee kind);

  const World& world_;
  FaultGate& faults_;
  RayFaults& ray_faults_;
  const Probe<Called>& called_;
  CandidateCounts& counts_;
  std::array<uint64_t, size_t(isa::kNumStages)> called_lanes_{};
};

}  // namespace glint::exec
