// Printing: the words that lanes give to a message become text in the launch's log.
// SPDX-License-Identifier: Apache-2.0
#include "base/num_lanes.h"
#include "exec/executor.h"

namespace glint::exec {

bool Executor::run_print(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  const uint32_t pc = warp.simt.pc++;
  if (!world_.prints || warp.regs.exec == 0) return true;
  const bool ends = row.effect == isa::Effect::Print;
  // Every lane has the same number: it is a constant (isa/verify.h).
  const isa::ParsedMessage& message =
      world_.image->shaders[world_.image->shader_of[pc]].messages[warp.regs.read(inst.operand[0])[0]];
  for_each_lane(warp.regs.exec, [&](int lane) {
    const auto id = launch_id(world_, warp.warp_index, lane);
    const uint64_t thread = (uint64_t{id[2]} * world_.launch_size[1] + id[1]) * world_.launch_size[0] + id[0];
    if (!world_.prints->wants(thread)) return world_.prints->add(thread, "", ends);
    uint32_t words[isa::kMessageWords];
    for (size_t i = 0; i < isa::kMessageWords; ++i) words[i] = warp.regs.read(inst.operand[1 + i])[lane];
    world_.prints->add(thread, isa::format_message(message, words), ends);
  });
  return true;
}

}  // namespace glint::exec
