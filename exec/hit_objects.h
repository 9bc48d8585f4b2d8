// Runs ho.*. A hit object keeps what a ray has found, or what a shader has made up, until its shader is
// executed.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "exec/rays.h"

namespace glint::exec {

class HitObjects {
 public:
  HitObjects(const World& world, FaultGate& faults, RayFaults& ray_faults, Rays& rays)
      : world_(world), faults_(faults), ray_faults_(ray_faults), rays_(rays) {}

  // Both functions return false after a fault.
  bool run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  // Opens a trace whose rays have already found what the objects hold.
  bool begin_trace(WarpContext& warp, const isa::Inst& inst);

 private:
  bool run_time(WarpContext& warp, const isa::Inst& inst, bool set);
  bool run_corner(WarpContext& warp, const isa::Inst& inst);
  bool record(WarpContext& warp, int lane, HitObject& object);
  bool make_hit(WarpContext& warp, const isa::Inst& inst, bool has_stride, int lane, HitObject& object);
  uint32_t value_of(const HitObject& object, uint32_t value) const;

  const World& world_;
  FaultGate& faults_;
  RayFaults& ray_faults_;
  Rays& rays_;
};

}  // namespace glint::exec
