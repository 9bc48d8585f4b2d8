// Constructs a core, launches its blocks, takes it through time and accounts for it.
// SPDX-License-Identifier: Apache-2.0
#include "core/core_cell.h"

#include <algorithm>
#include <bit>
#include <fmt/format.h>

#include "base/check.h"
#include "base/num_lanes.h"
#include "core/stall_report.h"

namespace glint::core {

CoreCell::CoreCell(const Params& params, const Context& context)
    : params_(params),
      world_(context.world),
      l1_(context.l1),
      rt_(context.rt),
      no_skip_(context.no_skip),
      shared_per_block_(needs_of(context.world, context.shared_per_warp).shared_bytes),
      table_(context.table ? context.table : std::make_shared<IssueTable>(*context.world.image, params)),
      executor_(context.world, context.clock_mhz),
      view_(context.turn ? std::make_unique<exec::MemoryView>() : nullptr),
      counts_(context.parent, context.name, context.world.image->code.size()),
      code_(CodeSupply::make(params_, context.world, context.places, context.l1, &counts_.stats)),
      places_(occupancy(params, context.world.image->num_registers)),
      warps_(num_slots(params, context.world), params_, context.world, *table_,
             code_ ? code_->fetch() : nullptr, observers_),
      lsu_(params, context.l1),
      mbarriers_(MbarrierUnit::make(parts())),
      subwarps_(SubwarpUnit::make(parts())),
      memory_(parts(),
              {lsu_, local_layout(params, context.world, context.local_physical),
               table_layout(context.world, context.tables), context.turn, mbarriers_.get(), subwarps_.get()}),
      constants_(parts(), code_ ? code_->constants() : nullptr),
      parking_(ParkingLot::make(parts(), memory_, places_)),
      rays_(parts(), context.rt, parking_.get()),
      barriers_(parts()),
      reorder_(ReorderUnit::make(parts(), memory_)),
      issue_(parts(),
             {memory_, constants_, rays_, barriers_, reorder_.get(), mbarriers_.get(), subwarps_.get()},
             doors_),
      seat_{0, warps_.size(), context.index, context.cores},
      news_(context.news),
      told_(kHasRoom) {
  executor_.use(view_.get());
  if (news_) *news_ = told_;
}

CoreCell::~CoreCell() = default;

uint32_t CoreCell::num_slots(const Params& params, const exec::World& world) {
  return num_warp_slots(params, occupancy(params, world.image->num_registers));
}

LocalLayout CoreCell::local_layout(const Params& params, const exec::World& world, Address base) {
  return {base, world.local_bytes / 4, params.local_by_thread, num_slots(params, world)};
}

uint64_t CoreCell::local_bytes(const Params& params, const exec::World& world) {
  return local_layout(params, world, 0).bytes();
}

rt::TableLayout CoreCell::table_layout(const exec::World& world, Address base) {
  return {base, world.any_hit ? world.any_hit->table_rows() : 0};
}

uint64_t CoreCell::table_bytes(const Params& params, const exec::World& world) {
  return table_layout(world, 0).bytes_per_warp() * num_slots(params, world);
}

uint64_t CoreCell::code_bytes(const Params& params, const exec::World& world) {
  return params.fetch.perfect ? 0 : uint64_t{world.image->code.size()} * kInstructionBytes;
}

uint64_t CoreCell::constant_bytes(const Params& params, const exec::World& world) {
  return params.constant.perfect ? 0 : world.constant_bank.size();
}

LaunchNeeds CoreCell::needs_of(const exec::World& world, uint32_t shared_per_warp) {
  const uint32_t warps = exec::warps_per_block(world);
  return {world.image->num_registers, warps, world.shared_bytes + warps * shared_per_warp,
          world.block_size[0] != 0};
}

bool CoreCell::has_room() const {
  const uint32_t blocks = warps_.blocks().num_taken();
  return num_held() + executor_.warps_per_block() <= places_ &&
         warps_.num_resident() + executor_.warps_per_block() <= warps_.size() &&
         blocks < warps_.blocks().size() && (blocks + 1) * shared_per_block_ <= params_.shared_bytes;
}

void CoreCell::launch(Cycle now, uint32_t block_index, Cycle ready) {
  GLINT_CHECK(has_room(), "no room for a block");
  active_until_ = std::max(active_until_, now);
  if (counts_.stats.blocks.value() > 0) ready = std::max(ready, block_start_ + params_.block_interval);
  if (const auto end = warps_.blocks().last_end()) ready = std::max(ready, *end + params_.refill_latency);
  block_start_ = ready;
  const uint32_t num_warps = executor_.warps_per_block();
  BlockSlot& home = warps_.blocks().take(num_warps);
  executor_.start(home.block, block_index);
  issue_.start_block();
  ++counts_.stats.blocks;
  for (uint32_t w = 0; w < num_warps; ++w) launch_warp(home, w, ready, now);
  count_residents(now);
  tell_news();
}

void CoreCell::tell_news() {
  if (!news_) return;
  const bool has_effects = view_ && view_->has_effects();
  const auto news =
      uint8_t((has_effects ? kHasEffects : 0) | (fault() ? kHasFault : 0) | (has_room() ? kHasRoom : 0));
  if (news != told_) *news_ = told_ = news;
}

void CoreCell::launch_warp(BlockSlot& home, uint32_t warp_in_block, Cycle ready, Cycle now) {
  const uint32_t slot = seat_.slot = warps_.first_free();
  exec::WarpContext& warp = warps_[slot].warp;
  executor_.start(warp, home.block, warp_in_block, seat_);
  memory_.start_warp(slot);
  warps_.start(slot, home, ready, now);
  ++counts_.stats.warps;
  counts_.stats.stage[size_t(world_.image->shaders[world_.raygen].stage)]->invocations +=
      num_lanes(warp.simt.active);
  ++counts_.progress;
  observers_.tell([&](CoreObserver& observer) { observer.start_warp(now, slot, warp); });
}

void CoreCell::advance(Cycle from, Cycle until) {
  Cycle now = no_skip_ ? from : next_event(from);
  while (now < until && !fault()) {
    step(now++);
    if (!no_skip_ && warps_.alarms().next(now) > now) now = next_event(now);
  }
  tell_news();
}

Cycle CoreCell::next_event(Cycle from) const {
  if (fault()) return kNever;
  Cycle next = warps_.alarms().next(from);
  if (next <= from) return from;
  if (from == 0) return finished() ? next : from;
  if (code_) [[unlikely]]
    next = std::min(next, code_->next_event(from - 1));
  if (reorder_) [[unlikely]]
    next = std::min(next, reorder_->next_event(from - 1));
  if (mbarriers_) [[unlikely]]
    next = std::min(next, mbarriers_->next_event());
  next = std::min({next, lsu_.next_event(from - 1), l1_.next_event(from - 1), rt_.next_event(from - 1),
                   memory_.next_event()});
  return std::max(next, from);
}

void CoreCell::step(Cycle now) {
  sampler_.reach(now);
  if (l1_.is_due(now)) l1_.tick(now);
  // Choice: the RT unit and the load-store unit alternate in who comes to the L1 first, so that neither
  // starves the other. The order does not matter while one of them has nothing to do, which is mostly the
  // case.
  const bool lsu_is_due = lsu_.is_due(now);
  const bool rt_is_due = rt_.is_due(now) | l1_.has_answer(now, mem::Client::RtUnit);
  if (lsu_is_due && rt_is_due && (now & 1) == 0) {
    lsu_.tick(now);
    rt_.tick(now);
  } else {
    if (rt_is_due) rt_.tick(now);
    if (lsu_is_due) lsu_.tick(now);
  }
  if (code_) [[unlikely]]
    code_->tick(now, warps_, constants_);
  if (residents_ == 0) return;  // An empty core's time has a reason already, and nothing can issue.
  memory_.take_answers(now);
  rays_.take_answers(now);
  if (reorder_) [[unlikely]]
    reorder_->tick(now);
  if (mbarriers_) [[unlikely]]
    mbarriers_->tick(now);
  issue(now);
  active_until_ = now + 1;
  if (parking_) [[unlikely]]
    rays_.let_return(now);
  if (warps_.num_resident() != residents_ || num_held() != held_) [[unlikely]] {
    count_residents(now);
    if (residents_ == 0) become_empty(now + 1);
  }
}

// Gives each scheduler that has something to do its turn.
void CoreCell::issue(Cycle now) {
  const Alarms& alarms = warps_.alarms();
  uint32_t due = no_skip_ ? (1u << params_.schedulers) - 1 : alarms.due(now);
  if (alarms.watching() & ~due) [[unlikely]]
    due |= find_open_doors(alarms.watching() & ~due);
  issue_.run(due, now);
}

// Returns those of the schedulers whose doors may have opened.
uint32_t CoreCell::find_open_doors(uint32_t watching) const {
  uint32_t open = 0;
  for (; watching; watching &= watching - 1) {
    const auto s = uint32_t(std::countr_zero(watching));
    open |= uint32_t{warps_.schedulers()[s].sees_open_door(doors_)} << s;
  }
  return open;
}

// Notes that the numbers of resident warps and of held places may be others from cycle `now` on.
void CoreCell::count_residents(Cycle now) {
  counts_.stats.resident_cycles += (now - residents_since_) * held_;
  residents_since_ = now;
  residents_ = warps_.num_resident();
  held_ = num_held();
}

// Notes that the core has no warp from cycle `now` on, which is the reason of its cycles then.
void CoreCell::become_empty(Cycle now) {
  for (Scheduler& scheduler : warps_.schedulers()) {
    counts_.spend(scheduler, now);
    scheduler.become_empty();
  }
}

void CoreCell::finish(Cycle end) {
  GLINT_CHECK_LE(active_until_, end);
  CoreStats& stats = counts_.stats;
  count_residents(end);
  for (Scheduler& scheduler : warps_.schedulers()) counts_.spend(scheduler, end);
  stats.cycles += end;
  stats.slot_cycles += end * params_.warps;
  sampler_.finish(end);
  counts_.settle(*table_, *world_.image);
  const exec::CandidateCounts& candidates = executor_.candidates();
  for (int stage = 0; stage < kNumStages; ++stage)
    stats.stage[size_t(stage)]->invocations += executor_.called_lanes(isa::Stage(stage));
  stats.candidate_calls += candidates.calls;
  stats.candidate_lanes += candidates.lanes;
  stats.candidates_gathered += candidates.gathered;
  stats.candidates_dropped += candidates.dropped;
  stats.table_overflows += candidates.overflows;
}

uint64_t CoreCell::turnover() const {
  const uint64_t launched = warps_.num_launched(), ended = launched - warps_.num_resident();
  return launched + ended;
}

uint64_t CoreCell::changes() const {
  return turnover() + counts_.stats.rt_warps.value() + executor_.changes();
}

void CoreCell::start_profile() {
  counts_.profile = std::make_unique<Profile>(world_.image->code.size(), params_.schedulers);
}

void CoreCell::observe(CoreObserver& observer) {
  observers_.add(observer);
  executor_.called.listen([&observer](const exec::Called& called) {
    observer.call(called.warp.slot, called.stage, called.lanes);
  });
}

bool CoreCell::hears_l1() {
  return warps_.schedulers().front().l1_listener() != nullptr;
}

void CoreCell::start_l1(uint32_t lines) {
  for (Scheduler& scheduler : warps_.schedulers()) scheduler.l1_listener()->start(lines);
}

void CoreCell::tell_missed(mem::Token access, Address line) {
  const uint32_t slot = lsu_.access(access).slot;
  warps_.schedulers()[slot % params_.schedulers].l1_listener()->missed(slot / params_.schedulers, line);
}

void CoreCell::tell_replaced(uint32_t place, std::optional<mem::Token> access,
                             std::optional<Address> victim) {
  for (Scheduler& scheduler : warps_.schedulers()) {
    std::optional<uint32_t> warp;
    if (access && lsu_.access(*access).slot % params_.schedulers == scheduler.index())
      warp = lsu_.access(*access).slot / params_.schedulers;
    scheduler.l1_listener()->replaced(place, warp, victim);
  }
}

std::string CoreCell::describe_stall() const {
  return fmt::format("{}: {} of {} warp slots in use\n", counts_.stats.name(), warps_.num_resident(),
                     warps_.size()) +
         describe_warps(warps_, memory_, world_) + l1_.describe() + rt_.describe();
}

}  // namespace glint::core
