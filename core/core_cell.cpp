// A core from outside: construction, launching warps, going through time and accounting for it.
// SPDX-License-Identifier: Apache-2.0
#include "core/core_cell.h"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/check.h"
#include "base/num_lanes.h"

namespace glint::core {

CoreCell::CoreCell(const Params& params, const Context& context)
    : params_(params),
      world_(context.world),
      l1_(context.l1),
      rt_(context.rt),
      no_skip_(context.no_skip),
      num_slots_(occupancy(params, context.world.image->num_registers)),
      local_{context.local_physical, context.world.local_bytes / 4},
      tables_(table_layout(context.world, context.tables)),
      table_(*context.world.image, params),
      executor_(context.world, context.clock_mhz),
      turn_(context.turn),
      holds_operands_(params.lsu.war_latency + params.lsu.shared_war_latency > 0),
      times_constants_(params.constant.serial || !params.constant.perfect),
      view_(context.turn ? std::make_unique<exec::MemoryView>() : nullptr),
      lsu_(params, context.l1),
      schedulers_(params.schedulers),
      warps_(num_slots_),
      scoreboards_(num_slots_),
      front_(num_slots_),
      outstanding_(num_slots_),
      stored_(num_slots_),
      fence_(num_slots_),
      home_(num_slots_),
      warps_per_block_(executor_.warps_per_block()),
      seat_{0, num_slots_, context.index, context.cores},
      line_(num_slots_),
      waits_for_line_(num_slots_),
      constant_(num_slots_),
      sequence_(num_slots_),
      rays_issued_(num_slots_),
      rays_pc_(num_slots_),
      rays_lanes_(num_slots_),
      stats_(context.parent, context.name),
      op_counts_(isa::op_table().size()),
      op_lanes_(isa::op_table().size()) {
  GLINT_CHECK(num_slots_ > 0, "no warp fits: check() reports this");
  executor_.use(view_.get());
  if (!params.fetch.perfect || !params.constant.perfect) {
    code_stats_ = std::make_unique<CodeStats>(&stats_);
    code_ = std::make_unique<Code>(params_, context, *code_stats_);
  }
  const bool counts_blocks = world_.block_size[0] != 0;
  const uint32_t places = counts_blocks ? std::min(params.blocks, num_slots_ / warps_per_block_) : num_slots_;
  GLINT_CHECK(places > 0, "no block fits: check_block() reports this");
  for (uint32_t i = 0; i < places; ++i) residents_.push_back(std::make_unique<Resident>());
  const uint32_t warps_each = (num_slots_ + params.schedulers - 1) / params.schedulers;
  for (uint32_t s = 0; s < params.schedulers; ++s) {
    schedulers_[s].index = s;
    schedulers_[s].policy = params.issue.make({warps_each});
    schedulers_[s].has_latches = params.dispatch_latch;
  }
}

CoreCell::~CoreCell() = default;

uint64_t CoreCell::local_bytes(const Params& params, const exec::World& world) {
  const LocalLayout layout{0, world.local_bytes / 4};
  return layout.bytes_per_warp() * occupancy(params, world.image->num_registers);
}

rt::TableLayout CoreCell::table_layout(const exec::World& world, Address base) {
  return {base, world.any_hit ? world.any_hit->table_rows() : 0};
}

uint64_t CoreCell::table_bytes(const Params& params, const exec::World& world) {
  return table_layout(world, 0).bytes_per_warp() * occupancy(params, world.image->num_registers);
}

LaunchNeeds CoreCell::needs_of(const exec::World& world) {
  return {world.image->num_registers, exec::warps_per_block(world), world.shared_bytes,
          world.block_size[0] != 0};
}

bool CoreCell::has_room() const {
  return num_resident_ + warps_per_block_ <= num_slots_ && num_blocks_ < residents_.size() &&
         uint64_t{num_blocks_ + 1} * world_.shared_bytes <= params_.shared_bytes;
}

void CoreCell::launch(Cycle now, uint32_t block_index, Cycle ready) {
  GLINT_CHECK(has_room(), "no room for a block");
  if (num_resident_ == 0)
    for (SchedulerState& scheduler : schedulers_) scheduler.reason = Stall::NoWarp;
  account_until(now);
  now_ = now;
  if (stats_.blocks.value() > 0) ready = std::max(ready, block_start_ + params_.block_interval);
  block_start_ = ready;
  Resident& home =
      **std::find_if(residents_.begin(), residents_.end(), [](const auto& r) { return r->warps == 0; });
  executor_.start(home.block, block_index);
  home.warps = warps_per_block_;
  ++num_blocks_;
  ++stats_.blocks;
  for (uint32_t w = 0; w < warps_per_block_; ++w) launch_warp(home, w, ready);
}

void CoreCell::launch_warp(Resident& home, uint32_t warp_in_block, Cycle ready) {
  uint32_t slot = 0;
  while (scheduler_of(slot).resident >> (slot / params_.schedulers) & 1) ++slot;
  SchedulerState& scheduler = scheduler_of(slot);
  const uint32_t local = slot / params_.schedulers;
  seat_.slot = slot;
  executor_.start(warps_[slot], home.block, warp_in_block, seat_);
  home_[slot] = &home;
  fence_[slot] = 0;
  stored_[slot] = false;
  scoreboards_[slot].reset();
  line_[slot] = InstructionFetch::kNone;
  waits_for_line_[slot] = false;
  front_[slot] = {ready, Stall::Dispatch};
  sequence_[slot] = {params_.prologue.instructions +
                     (world_.shared_bytes > 0 ? params_.prologue.shared_instructions : 0)};
  scheduler.resident |= uint64_t{1} << local;
  scheduler.age[local] = num_launched_++;
  ++num_resident_;
  ++stats_.warps;
  stats_.stage[size_t(world_.image->shaders[world_.raygen].stage)]->invocations +=
      num_lanes(warps_[slot].simt.active);
  ++progress_;
  refresh(slot);
  for (CoreObserver* observer : observers_) observer->start_warp(now_, slot, warps_[slot]);
}

void CoreCell::advance(Cycle from, Cycle until) {
  Cycle now = no_skip_ ? from : next_event(from);
  while (now < until && !fault_) {
    step(now);
    now = no_skip_ ? now + 1 : next_event(now + 1);
  }
}

Cycle CoreCell::next_event(Cycle from) const {
  if (fault_) return kNever;
  Cycle next = kNever;
  for (const SchedulerState& scheduler : schedulers_) next = std::min(next, scheduler.sleep_until);
  if (next <= from) return from;
  if (from == 0) return finished() ? next : from;
  if (code_) next = std::min(next, code_->cache.next_event(from - 1));
  next = std::min({next, lsu_.next_event(from - 1), l1_.next_event(from - 1), rt_.next_event(from - 1)});
  return std::max(next, from);
}

void CoreCell::step(Cycle now) {
  sampler_.reach(now);
  now_ = now;
  const bool had_warps = num_resident_ > 0;
  if (had_warps) account_until(now);
  l1_.tick(now);
  // Choice: who comes to the L1 first alternates, so that neither starves the other.
  if (now & 1) rt_.tick(now);
  lsu_.tick(now);
  if (!(now & 1)) rt_.tick(now);
  if (code_) take_code(now);
  if (holds_operands_)
    for (uint32_t id : lsu_.accepted()) read_operands(id, now);
  for (uint32_t id : lsu_.completed()) complete(id, now);
  while (const auto slot = rt_.pop_completion(now)) complete_rays(*slot, now);
  for (SchedulerState& scheduler : schedulers_) {
    const bool door =
        scheduler.watches_rt || (scheduler.watches_lsu && scheduler.lsu_vacated != lsu_.num_vacated());
    if (now < scheduler.sleep_until && !door && !no_skip_) continue;
    run_scheduler(scheduler, now);
    if (fault_) break;
  }
  // An empty core's time is accounted for when a warp comes or the run ends.
  if (had_warps) account_until(now + 1);
}

// Gives the cycles since the last call to the schedulers' reasons.
void CoreCell::account_until(Cycle now) {
  if (now <= accounted_) return;
  const uint64_t cycles = now - accounted_;
  for (SchedulerState& scheduler : schedulers_) stats_.stalls.add(scheduler.reason, cycles);
  if (profile_)
    for (SchedulerState& scheduler : schedulers_) profile_->spend(scheduler.index, scheduler.reason, cycles);
  stats_.cycles += cycles;
  stats_.resident_cycles += cycles * num_resident_;
  stats_.slot_cycles += cycles * params_.warps;
  accounted_ = now;
}

void CoreCell::finish(Cycle end) {
  GLINT_CHECK_LE(accounted_, end);
  if (num_resident_ == 0)
    for (SchedulerState& scheduler : schedulers_) scheduler.reason = Stall::NoWarp;
  account_until(end);
  sampler_.finish(end);
  const exec::CandidateCounts& counts = executor_.candidates();
  for (int stage = 0; stage < kNumStages; ++stage)
    stats_.stage[size_t(stage)]->invocations += executor_.called_lanes(isa::Stage(stage));
  stats_.candidate_calls += counts.calls;
  stats_.candidate_lanes += counts.lanes;
  stats_.candidates_gathered += counts.gathered;
  stats_.candidates_dropped += counts.dropped;
  stats_.table_overflows += counts.overflows;
}

std::string CoreCell::describe_stall() const {
  std::string out = fmt::format("{}: {} of {} warp slots in use\n", stats_.name(), num_resident_, num_slots_);
  std::vector<std::pair<std::string, std::vector<uint64_t>>> groups;  // what is said of warps, and of which
  for (uint32_t slot = 0; slot < num_slots_; ++slot) {
    if (!(schedulers_[slot % params_.schedulers].resident >> slot / params_.schedulers & 1)) continue;
    std::string text = describe_warp(slot);
    const auto same =
        std::find_if(groups.begin(), groups.end(), [&](const auto& group) { return group.first == text; });
    if (same == groups.end())
      groups.push_back({std::move(text), {warps_[slot].warp_index}});
    else
      same->second.push_back(warps_[slot].warp_index);
  }
  for (const auto& [text, warps] : groups)
    out += fmt::format("  warp{} {}: {}\n", warps.size() > 1 ? "s" : "", fmt::join(warps, ", "), text);
  return out + l1_.describe() + rt_.describe();
}

// Where the warp is, what it waits for, and whom: the warps of its block, or whoever writes what it read
// last.
std::string CoreCell::describe_warp(uint32_t slot) const {
  const SchedulerState& scheduler = schedulers_[slot % params_.schedulers];
  const uint32_t local = slot / params_.schedulers;
  const exec::WarpContext& warp = warps_[slot];
  const Cycle ready = scheduler.ready_at[local];
  std::string out = fmt::format(
      "at {}, waits for {} {}, {} accesses in flight",
      warp.simt.finished() ? "its end" : world_.image->place_of(warp.simt.pc), name_of(scheduler.wait[local]),
      ready == kNever ? std::string("without a known end") : fmt::format("until cycle {}", ready),
      outstanding_[slot]);
  if (warp.waiting_at_barrier) {
    std::vector<uint64_t> missing;
    const exec::Block& block = home_[slot]->block;
    for (uint32_t w = 0; w < block.num_warps(); ++w)
      if ((block.live() & ~block.waiting()) >> w & 1) missing.push_back(block.warps[w]->warp_index);
    out += fmt::format(", at barrier {} for warps {}", warp.barrier, fmt::join(missing, ", "));
  } else if (!warp.simt.finished() && warp.simt.active != 0) {
    const Address address = warp.regs.access.address[size_t(std::countr_zero(warp.simt.active))];
    if (world_.memory->find(address, 1))
      out += ", last access: " + exec::whereabouts(*world_.memory, address, 1);
  }
  return out;
}

}  // namespace glint::core
