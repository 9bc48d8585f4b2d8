// Hears of accesses, and hands on their lines.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/line_touches.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "base/num_lanes.h"
#include "isa/effects.h"

namespace glint::pipeline {

LineTouches::LineTouches(const exec::World& world, const mem::Params& params, Sink sink, Written written)
    : world_(world),
      line_shift_(uint32_t(std::countr_zero(params.line))),
      written_(written),
      sink_(std::move(sink)),
      nodes_([this](const rt::Fetch& fetch) {
        touch_bytes(world_.memory->physical(fetch.address), fetch.bytes);
      }),
      lines_(params.line),
      recent_(std::bit_floor(std::max<uint64_t>(1, params.l1.size / params.line))) {
}

void LineTouches::listen_to(exec::Executor& executor) {
  executor.retired.listen([this, &executor](const exec::Retired& retired) { touch(executor, retired); });
}

void LineTouches::touch(const exec::Executor& executor, const exec::Retired& retired) {
  const exec::Issued& issued = retired.issued;
  const isa::Effect effect = issued.row->effect;
  if (effect == isa::Effect::None) return;
  const isa::Access& addresses = retired.warp.regs.access;
  const isa::EffectFamily family = isa::effect_row(effect).family;
  const bool writes = isa::effect_row(effect).writes_memory;
  Address last = 0;  // chunk that was told; no allocation has chunk 0
  lines_.clear();
  if (family == isa::EffectFamily::Memory) {
    const LaneMask lanes = executor.lanes_in(isa::Space::Global);
    const auto bytes = uint32_t(issued.row->memory.bytes * issued.row->memory.count);
    coalesce_global(lines_, *world_.memory, addresses, lanes, bytes);
    if (writes && writes_)
      for_each_lane(lanes, [&](int lane) { tell_write(addresses.address[size_t(lane)], bytes, last); });
  } else if (isa::is_shader_call(effect)) {
    coalesce_global(lines_, *world_.memory, addresses, issued.lanes, mem::kSectorBytes);
  } else if (family == isa::EffectFamily::Image) {
    for (const auto& texels : executor.texels().rows())
      for_each_lane(issued.lanes, [&](int lane) {
        const Address texel = texels[size_t(lane)];
        if (texel == exec::TexelList::kNone) return;
        lines_.add(world_.memory->physical(texel), 4, lane);
        if (writes && writes_) tell_write(texel, 1, last);  // All bytes of a texel lie in one chunk.
      });
  }
  const mem::Touch how = writes && written_ == Written::StaysDirty ? mem::Touch::Write : mem::Touch::Read;
  for (const core::LineSectors& line : lines_.lines()) touch_line(line.line, line.sectors, how);
}

void LineTouches::tell_write(Address first, uint32_t bytes, Address& last) const {
  for (Address chunk = first >> kChunkShift; chunk <= (first + bytes - 1) >> kChunkShift; ++chunk)
    if (chunk != last) writes_(last = chunk);
}

// Nodes lie in one line or two.
void LineTouches::touch_bytes(Address physical, uint32_t bytes) {
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

void LineTouches::touch_line(Address line, uint8_t sectors, mem::Touch touch) {
  Recent& recent = recent_[(line >> line_shift_) & (recent_.size() - 1)];
  if (recent.line != line) recent = {line, 0, 0};
  uint8_t& known = touch == mem::Touch::Write ? recent.written : recent.sectors;
  if ((known & sectors) == sectors) return;
  recent.sectors |= sectors;
  known |= sectors;
  lost_ += sink_(line, sectors, touch);
}

}  // namespace glint::pipeline
