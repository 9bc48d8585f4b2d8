// Takes the accesses of warps to the memory model: load-store unit, shared memory, lines.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>

#include "base/num_lanes.h"
#include "pipeline/interval/interval_core.h"

namespace glint::pipeline {

using core::Finish;
using isa::Effect;
using isa::Space;

// Returns when the data that an instruction loads are there. What it stores costs the warp nothing more.
Cycle IntervalMachine::access(Core& core, uint32_t slot, const exec::Issued& issued,
                              const core::IssueRow& row, Cycle at) {
  core.lines.clear();
  const isa::Access& addresses = core.warps[slot].context.regs.access;
  const auto bytes = uint32_t(issued.row->memory.bytes * issued.row->memory.count);
  const bool is_atomic = issued.row->effect == Effect::Atomic;
  const Cycle accepted = core.lsu.take(at, params_.core.lsu.accept_interval);
  const Cycle begin = accepted + (row.is_texture ? params_.core.units.tex : params_.core.units.lsu).latency;
  Cycle done = std::max<Cycle>(begin, at + row.latency);
  LaneMask local = 0;
  if (row.is_texture) {
    for (const auto& texels : executor_.texels().rows())
      for_each_lane(issued.lanes, [&](int lane) {
        if (texels[size_t(lane)] != exec::TexelList::kNone)
          core.lines.add(world_.memory->physical(texels[size_t(lane)]), 4, lane);
      });
  } else if (row.finish == Finish::CallRecord) {
    coalesce_global(core.lines, *world_.memory, addresses, issued.lanes, mem::kSectorBytes);
  } else {
    local = executor_.lanes_in(Space::Local);
    coalesce_local(core.lines, core.local, slot, addresses, local, bytes);
    coalesce_global(core.lines, *world_.memory, addresses, executor_.lanes_in(Space::Global), bytes);
    if (is_atomic)
      count_turns(core.lines, *world_.memory, addresses, bytes, params_.core.lsu.atomic_turns,
                  !isa::only_writes_memory(issued.row->effect));
    const bool is_copy = issued.row->effect == Effect::Copy;
    if (const LaneMask lanes = executor_.lanes_in(Space::Shared))
      done = std::max(done, access_shared(core,
                                          core::shared_passes(is_copy ? executor_.copied_to() : addresses,
                                                              lanes, bytes, is_atomic || is_copy),
                                          is_atomic, accepted));
  }
  return std::max(done, access_lines(core, issued, begin, local != 0));
}

// Returns when shared memory has answered. Model: each atomic takes the time of an integer one.
Cycle IntervalMachine::access_shared(Core& core, uint32_t passes, bool is_atomic, Cycle at) {
  const core::SharedParams& shared = params_.core.shared;
  const Cycle more = passes - 1, work = is_atomic ? 1 + more * shared.atomic_pass : passes;
  const Cycle begin = core.shared.take(at, double(work));
  if (is_atomic)
    return begin + shared.atomic_latency +
           (std::max<Cycle>(more * shared.atomic_pass, shared.atomic_hidden) - shared.atomic_hidden);
  return begin + shared.latency +
         (std::max<Cycle>(more * shared.conflict_turn, shared.conflict_hidden) - shared.conflict_hidden);
}

// Sends the lines of an access to the L1, and returns when what it loads has come.
Cycle IntervalMachine::access_lines(Core& core, const exec::Issued& issued, Cycle begin, bool is_local) {
  const bool is_write = isa::only_writes_memory(issued.row->effect);
  const core::LsuParams& lsu = params_.core.lsu;
  Cycle sent = std::max(begin, core.held_until), done = 0;
  for (const core::LineSectors& line : core.lines.lines()) {
    const auto sectors = uint32_t(std::popcount(line.sectors));
    const uint32_t cycles = (sectors + lsu.sectors_per_cycle - 1) / lsu.sectors_per_cycle;
    sent = core.door.take(sent, std::max(1.0 / lsu.lines_per_cycle, double(cycles)));
    if (issued.row->effect == Effect::Atomic) {
      const Cycle changed = memory_.change(core.index, line.line, line.sectors,
                                           std::max<uint32_t>(line.atomic().turns, sectors), sent);
      if (!is_write) done = std::max(done, changed);
    } else if (is_write) {
      const Cycle gone = memory_.write(core.index, line.line, line.sectors, sent, is_local);
      if (gone > sent + params_.memory.l1.miss_latency + params_.memory.l1.miss_queue)
        core.held_until = gone - params_.memory.l1.miss_latency - params_.memory.l1.miss_queue;
    } else {
      done = std::max(done, memory_.read(core.index, line.line, line.sectors, sent, Asker::Shader));
    }
    ++sent;
  }
  return done;
}

}  // namespace glint::pipeline
