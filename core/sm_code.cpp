// A core's instructions and constants: coming to lines that may not be there, and the lines that arrive.
// SPDX-License-Identifier: Apache-2.0
#include "core/core_cell.h"

namespace glint::core {
namespace {

constexpr uint32_t kConstantClient = kMaxSchedulers;  // of the cache behind; the schedulers come before

}  // namespace

CoreCell::Code::Code(const Params& params, const Context& context, CodeStats& stats)
    : cache(params.code_cache, InstructionFetch::most_in_flight(params.schedulers) + ConstantCache::kMost,
            context.l1, stats) {
  if (!params.fetch.perfect)
    fetch = std::make_unique<InstructionFetch>(params.fetch, params.schedulers, context.code,
                                               context.world.image->code.size(), cache, stats);
  if (!params.constant.perfect)
    constants =
        std::make_unique<ConstantCache>(params.constant, context.constants,
                                        context.world.constant_bank.size(), kConstantClient, cache, stats);
}

uint64_t CoreCell::code_bytes(const Params& params, const exec::World& world) {
  return params.fetch.perfect ? 0 : uint64_t{world.image->code.size()} * kInstructionBytes;
}

uint64_t CoreCell::constant_bytes(const Params& params, const exec::World& world) {
  return params.constant.perfect ? 0 : world.constant_bank.size();
}

// The warp's next instruction may be in another line than the one before it.
void CoreCell::come_to_line(uint32_t slot) {
  const uint32_t line = code_->fetch->line_of(warps_[slot].simt.pc);
  if (line == line_[slot]) return;
  line_[slot] = line;
  waits_for_line_[slot] = !code_->fetch->come_to(slot % params_.schedulers, line, now_);
}

void CoreCell::take_code(Cycle now) {
  code_->cache.tick(now);
  for (const CodeCache::Answer& answer : code_->cache.answers()) {
    if (answer.client == kConstantClient) {
      code_->constants->arrive(answer.line, [&](uint32_t slot) { finish_constant(slot, now); });
      continue;
    }
    const uint32_t line = code_->fetch->arrive(answer.client, answer.line);
    if (line == InstructionFetch::kNone) continue;
    for (uint32_t slot = answer.client; slot < num_slots_; slot += params_.schedulers) {
      if (!waits_for_line_[slot] || line_[slot] != line) continue;
      waits_for_line_[slot] = false;
      refresh(slot);
    }
  }
}

// A load that misses waits in front of its warp, and is looked up again when its lines have come.
void CoreCell::start_constant(SchedulerState& scheduler, uint32_t slot, const IssueRow& row,
                              const exec::Issued& issued, Cycle now) {
  const isa::Access& access = warps_[slot].regs.access;
  const Cycle turns = params_.constant.serial ? different_words(access, issued.lanes) : 1;
  scheduler.take(row.pipe, now, turns * row.interval);
  constant_[slot] = {issued.pc, now, row.latency + (turns - 1) * row.interval / OpTime::kParts};
  const uint64_t offset = issued.row->memory.space == isa::Space::Param ? isa::kPushConstantOffset : 0;
  if (!code_ || !code_->constants || code_->constants->look_up(slot, access, issued.lanes, offset, now)) {
    finish_constant(slot, now);
    return;
  }
  front_[slot] = {kNever, Stall::Const};
}

void CoreCell::finish_constant(uint32_t slot, Cycle now) {
  const ConstantLoad& load = constant_[slot];
  const IssueRow& row = table_.row(load.pc);
  scoreboards_[slot].set(table_.defs(row), {now + load.latency, row.wait}, row.pipe);
  stats_.add_latency(row.stage, row.klass, now + load.latency - load.issued);
  if (now == load.issued) return;
  front_[slot] = {now, Stall::Const};
  ++progress_;
  refresh(slot);
}

}  // namespace glint::core
