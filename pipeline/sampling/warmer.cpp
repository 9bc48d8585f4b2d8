// Hears of the accesses of blocks, and hands their lines to the L2.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/warmer.h"

#include <algorithm>

#include "base/num_lanes.h"
#include "isa/effects.h"

namespace glint::pipeline {

Warmer::Warmer(const exec::World& world, uint64_t instruction_budget, const mem::Params& params,
               mem::MemorySystem& memory)
    : world_(world),
      line_bytes_(params.line),
      memory_(memory),
      executor_(world),
      endless_(*world.image),
      runner_(world, endless_, instruction_budget),
      nodes_([this](const rt::Fetch& fetch) {
        touch_bytes(world_.memory->physical(fetch.address), fetch.bytes);
      }),
      lines_(params.line),
      recent_(std::max<uint64_t>(1, params.l1.size / params.line)) {
  executor_.retired.listen([this](const exec::Retired& retired) { touch(retired); });
}

WorkCounts Warmer::run(uint32_t index) {
  WorkCounts counts;
  try {
    runner_.run(
        executor_, index, counts, [] { return false; }, nullptr, nodes_);
  } catch (const BlockRunner::Failed& failed) {
    throw Error(failed.fault.exit(), executor_.passed().with(failed.fault));
  }
  return counts;
}

void Warmer::touch(const exec::Retired& retired) {
  const exec::Issued& issued = retired.issued;
  const isa::Effect effect = issued.row->effect;
  if (effect == isa::Effect::None) return;
  const isa::Access& addresses = retired.warp.regs.access;
  const isa::EffectFamily family = isa::effect_row(effect).family;
  lines_.clear();
  if (family == isa::EffectFamily::Memory)
    coalesce_global(lines_, *world_.memory, addresses, executor_.lanes_in(isa::Space::Global),
                    uint32_t(issued.row->memory.bytes * issued.row->memory.count));
  else if (isa::is_shader_call(effect))
    coalesce_global(lines_, *world_.memory, addresses, issued.lanes, mem::kSectorBytes);
  else if (family == isa::EffectFamily::Image)
    for (const auto& texels : executor_.texels().rows())
      for_each_lane(issued.lanes, [&](int lane) {
        if (texels[size_t(lane)] != exec::TexelList::kNone)
          lines_.add(world_.memory->physical(texels[size_t(lane)]), 4, lane);
      });
  for (const core::LineSectors& line : lines_.lines()) touch_line(line.line, line.sectors);
}

void Warmer::touch_bytes(Address physical, uint32_t bytes) {
  for (Address sector = physical / mem::kSectorBytes * mem::kSectorBytes; sector < physical + bytes;
       sector += mem::kSectorBytes)
    touch_line(sector / line_bytes_ * line_bytes_, uint8_t(1u << sector % line_bytes_ / mem::kSectorBytes));
}

void Warmer::touch_line(Address line, uint8_t sectors) {
  Recent& recent = recent_[line / line_bytes_ % recent_.size()];
  if (recent.line == line && (recent.sectors & sectors) == sectors) return;
  recent.sectors = recent.line == line ? uint8_t(recent.sectors | sectors) : sectors;
  recent.line = line;
  memory_.warm(line, sectors);
}

}  // namespace glint::pipeline
