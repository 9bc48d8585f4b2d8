// Stops a run at a mistake of its program, or notes the mistake.
// SPDX-License-Identifier: Apache-2.0
#include "exec/fault_gate.h"

#include <bit>
#include <fmt/format.h>
#include <utility>

#include "exec/endless_loops.h"
#include "exec/launch.h"

namespace glint::exec {

Fault no_end_in_sight(const World& world, const WarpContext& warp, uint32_t pc, uint64_t instruction_budget) {
  const int lane = warp.simt.active ? std::countr_zero(warp.simt.active) : 0;
  const std::string loops = loops_around(*world.image, pc);
  return {fmt::format("no end in sight: the warp has executed more than {} instructions, and "
                      "--max-instructions allows more{}{}",
                      instruction_budget, loops.empty() ? "" : "; the warp is ", loops),
          world.image->place_of(pc), shader_thread_id(warp, lane)};
}

bool FaultGate::fail(const WarpContext& warp, int lane, std::string what) {
  return fail({std::move(what), world_.image->place_of(warp.simt.pc), shader_thread_id(warp, lane)});
}

bool FaultGate::fail(Fault fault) {
  fault_ = std::move(fault);
  return false;
}

bool FaultGate::let_pass(const WarpContext& warp, int lane, FaultKind kind,
                         const std::function<std::string()>& what) {
  if (world_.on_fault == OnFault::Stop) return fail(warp, lane, what());
  const std::array<uint32_t, 3> id = thread_id(world_, warp, lane), &size = world_.launch_size;
  const uint64_t index = id[0] + uint64_t{size[0]} * (id[1] + uint64_t{size[1]} * id[2]);
  passed_.note(warp.simt.pc, kind, index, [&] {
    return Fault{what(), world_.image->place_of(warp.simt.pc), shader_thread_id(warp, lane)};
  });
  return true;
}

}  // namespace glint::exec
