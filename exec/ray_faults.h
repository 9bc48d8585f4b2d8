// Mistakes of programs that trace rays: records outside of the binding table, and structures that are none.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "exec/fault_gate.h"
#include "rtunit/ray_state.h"

namespace glint::exec {

// Each function answers as FaultGate::let_pass().
class RayFaults {
 public:
  RayFaults(const World& world, FaultGate& gate) : world_(world), gate_(gate) {}

  // A record outside of its region calls nothing. `how`: the numbers that name it.
  bool let_pass_record(const WarpContext& warp, int lane, std::string_view region, uint32_t record,
                       size_t records, const std::string& how = {});
  bool let_pass_hit_record(const WarpContext& warp, int lane, const rt::Ray& ray, const rt::Hit& hit);
  // A ray misses what is no structure.
  bool let_pass_structure(const WarpContext& warp, int lane, std::string_view verb, Address structure);
  // A ray whose structure's bytes led outside of memory has missed.
  bool let_pass_broken(const WarpContext& warp, int lane, rt::RayState& state);

 private:
  const World& world_;
  FaultGate& gate_;
};

}  // namespace glint::exec
