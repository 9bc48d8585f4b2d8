// Hears of the accesses of blocks, and hands on their lines.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/warmer.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "base/num_lanes.h"
#include "isa/effects.h"

namespace glint::pipeline {

Warmer::Warmer(const exec::World& world, uint64_t instruction_budget, const mem::Params& params, Sink sink,
               Written written)
    : world_(world),
      line_shift_(uint32_t(std::countr_zero(params.line))),
      written_(written),
      sink_(std::move(sink)),
      executor_(world),
      endless_(*world.image),
      runner_(world, endless_, instruction_budget),
      nodes_([this](const rt::Fetch& fetch) {
        touch_bytes(world_.memory->physical(fetch.address), fetch.bytes);
      }),
      lines_(params.line),
      recent_(std::bit_floor(std::max<uint64_t>(1, params.l1.size / params.line))) {
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
  const bool writes = isa::effect_row(effect).writes_memory;
  const mem::Touch how = writes && written_ == Written::StaysDirty ? mem::Touch::Write : mem::Touch::Read;
  for (const core::LineSectors& line : lines_.lines()) touch_line(line.line, line.sectors, how);
}

// Nodes lie in one line or two.
void Warmer::touch_bytes(Address physical, uint32_t bytes) {
  constexpr uint32_t kShift = std::countr_zero(mem::kSectorBytes);
  const uint32_t in_line = line_shift_ - kShift;  // a line has 1 << in_line sectors
  const Address end = (physical + bytes - 1) >> kShift;
  for (Address sector = physical >> kShift; sector <= end;) {
    const Address line = sector >> in_line, last = std::min(end, ((line + 1) << in_line) - 1);
    const auto first_bit = uint32_t(sector - (line << in_line)), bits = uint32_t(last - sector + 1);
    touch_line(line << line_shift_, uint8_t(((1u << bits) - 1) << first_bit), mem::Touch::Read);
    sector = last + 1;
  }
}

void Warmer::touch_line(Address line, uint8_t sectors, mem::Touch touch) {
  Recent& recent = recent_[(line >> line_shift_) & (recent_.size() - 1)];
  if (recent.line != line) recent = {line, 0, 0};
  uint8_t& known = touch == mem::Touch::Write ? recent.written : recent.sectors;
  if ((known & sectors) == sectors) return;
  recent.sectors |= sectors;
  known |= sectors;
  lost_ += sink_(line, sectors, touch);
}

}  // namespace glint::pipeline
