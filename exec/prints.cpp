// Turns the words that lanes give to a message into text in the launch's log.
// SPDX-License-Identifier: Apache-2.0
#include "exec/prints.h"

#include <cstddef>
#include <fmt/format.h>
#include <string>

#include "base/num_lanes.h"
#include "exec/launch.h"

namespace glint::exec {

namespace {

// Returns the text at an address of global memory, up to its zero byte or to a limit. Choice: an address that
// is not in memory has a text that says so; hardware would end the launch.
std::string text_at(const mem::AddressSpace& memory, Address address) {
  constexpr size_t kMostCharacters = 4096;
  std::string out;
  while (out.size() < kMostCharacters) {
    const std::byte* const at = memory.find(address + out.size(), 1);
    if (!at) return fmt::format("(no text at {:#x})", address);
    if (*at == std::byte{}) break;
    out += char(*at);
  }
  return out;
}

}  // namespace

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
    const auto text = [&](uint64_t address) { return text_at(*world.memory, address); };
    world.prints->add(thread, isa::format_message(message, words, text), ends);
  });
}

}  // namespace glint::exec
