// Runs ray queries: rq.*, whose rays a shader walks by itself.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "exec/rays.h"

namespace glint::exec {

class RayQueries {
 public:
  RayQueries(const World& world, FaultGate& faults, RayFaults& ray_faults)
      : world_(world), faults_(faults), ray_faults_(ray_faults) {}

  // Returns false after a fault.
  bool run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);

 private:
  bool begin(WarpContext& warp, const isa::Inst& inst, rt::RayState* states);
  void decide(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, rt::RayState* states);

  const World& world_;
  FaultGate& faults_;
  RayFaults& ray_faults_;
};

}  // namespace glint::exec
