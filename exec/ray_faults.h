// Reports mistakes of programs that trace rays: records outside of the binding table, and invalid structures.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "exec/fault_gate.h"
#include "rtunit/traversal/ray_state.h"

namespace glint::exec {

// Each function returns what FaultGate::let_pass() returns.
class RayFaults {
 public:
  RayFaults(const World& world, FaultGate& gate) : world_(world), gate_(gate) {}

  // Reports a record outside of its region, which calls nothing. `how` holds the numbers that name it.
  bool let_pass_record(const WarpContext& warp, int lane, std::string_view region, uint32_t record,
                       size_t records, const std::string& how = {});
  bool let_pass_hit_record(const WarpContext& warp, int lane, const rt::Ray& ray, const rt::Hit& hit);
  // Reports a ray that is traced into something that is not a structure. The ray misses.
  bool let_pass_structure(const WarpContext& warp, int lane, std::string_view verb, Address structure);
  // Reports a ray that has missed because its structure's bytes led outside of memory.
  bool let_pass_broken(const WarpContext& warp, int lane, rt::RayState& state);

 private:
  const World& world_;
  FaultGate& gate_;
};

}  // namespace glint::exec
