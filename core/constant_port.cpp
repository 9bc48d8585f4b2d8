// Implements the constant port of a core.
// SPDX-License-Identifier: Apache-2.0
#include "core/constant_port.h"

namespace glint::core {

ConstantPort::ConstantPort(const CoreParts& core, ConstantCache* cache)
    : core_(core),
      cache_(cache),
      is_serial_(core.params.constant.serial),
      is_timed_(is_serial_ || cache != nullptr),
      loads_(core.warps.size()) {
}

// Starts a load. A load that misses keeps its warp from issuing, and has its result one hit latency after its
// last line has come.
void ConstantPort::start(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now) {
  WarpSlot& at = core_.warps[slot];
  const isa::Access& access = at.warp.regs.access;
  const Cycle more = is_serial_ ? different_addresses(access, issued.lanes) - 1 : 0;
  const ConstantParams& params = core_.params.constant;
  const Cycle interval = params.place_interval ? params.place_interval * OpTime::kParts : row.interval;
  const Cycle latency = params.place_latency ? params.place_latency * OpTime::kParts : row.interval;
  at.scheduler->take(row.pipe, now, row.interval + more * interval);
  loads_[slot] = {issued.pc, now, row.latency + more * latency / OpTime::kParts};
  const uint64_t offset = issued.row->memory.space == isa::Space::Param ? isa::kPushConstantOffset : 0;
  if (cache_ && !cache_->look_up(slot, access, issued.lanes, offset, now))
    at.front = {kNever, Stall::Const};
  else
    finish(slot, now);
}

void ConstantPort::take_line(Address line, Cycle now) {
  cache_->arrive(line, [&](uint32_t slot) { finish(slot, now); });
}

void ConstantPort::finish(uint32_t slot, Cycle now) {
  WarpSlot& at = core_.warps[slot];
  const Load& load = loads_[slot];
  const IssueRow& row = core_.table.row(load.pc);
  at.scoreboard.set(core_.table.defs(row), {now + load.latency, row.wait}, row.pipe);
  core_.counts.end(load.pc, now + load.latency - load.issued);
  if (now == load.issued) return;
  at.front = {now, Stall::Const};
  ++core_.counts.progress;
  core_.warps.refresh(slot, now);
}

}  // namespace glint::core
