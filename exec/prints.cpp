// Turns the words that lanes give to a message into text in the launch's log.
// SPDX-License-Identifier: Apache-2.0
#include "exec/prints.h"

#include "base/num_lanes.h"
#include "exec/launch.h"

namespace glint::exec {

void run_print(const World& world, WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  const uint32_t pc = warp.simt.pc++;
  if (!world.prints || warp.regs.exec == 0) return;
  const bool ends = row.effect == isa::Effect::Print;
  // Every lane has the same number, because it is a constant (isa/verify.h).
  const isa::ParsedMessage& message =
      world.image->shaders[world.image->shader_of[pc]].messages[warp.regs.read(inst.operand[0])[0]];
  for_each_lane(warp.regs.exec, [&](int lane) {
    const auto id = thread_id(world, warp, lane);
    const uint64_t thread = (uint64_t{id[2]} * world.launch_size[1] + id[1]) * world.launch_size[0] + id[0];
    if (!world.prints->wants(thread)) return world.prints->add(thread, "", ends);
    uint32_t words[isa::kMessageWords];
    for (size_t i = 0; i < isa::kMessageWords; ++i) words[i] = warp.regs.read(inst.operand[1 + i])[lane];
    world.prints->add(thread, isa::format_message(message, words), ends);
  });
}

}  // namespace glint::exec
