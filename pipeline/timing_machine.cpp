// Builds the GPU and runs a launch on it.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/timing_machine.h"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <span>
#include <utility>

#include "base/check.h"
#include "exec/launch.h"
#include "pipeline/check_params.h"
#include "pipeline/conservation.h"
#include "pipeline/functional_machine.h"

namespace glint::pipeline {
namespace {

constexpr Cycle kLookPeriod = 4096;  // Choice: looks at the warps are so rare that they cost nothing

// Returns why the watch ends the launch before the turn at `now`, or Whole when it does not.
LaunchEnd early_end(const LaunchWatch& watch, Cycle now) {
  if (watch.max_cycles && now >= watch.max_cycles) return LaunchEnd::MaxCycles;
  return watch.stop && watch.stop() ? LaunchEnd::Stopped : LaunchEnd::Whole;
}

// Returns the bytes of shared memory that each warp of the launch needs for the stacks of its rays.
uint32_t stack_bytes_per_warp(const GpuParams& params, const exec::World& world) {
  if (params.rt.unit == rt::kSoftware) return 0;
  return traces_rays(world) ? rt::RtUnit::shared_bytes_per_warp(params.rt) : 0;
}

// Returns the number of threads beyond which threads wait more than they help. Choice: a core's work in a
// window is the least that a thread can do, and a partition has a tenth to a half of it.
uint32_t most_threads(const GpuParams& params) {
  return params.cores + (params.memory.dram.channels + 3) / 4;
}

// Checks the parameters before anything is built from them.
const GpuParams& checked(const GpuParams& params, const exec::World& world) {
  Diagnostics diagnostics;
  check(params, diagnostics);
  core::check(params.core, world.image->num_registers, diagnostics);
  const auto& block = world.block_size;
  core::check_block(params.core, world.image->num_registers, uint64_t(block[0]) * block[1] * block[2],
                    core::CoreCell::needs_of(world, stack_bytes_per_warp(params, world)).shared_bytes,
                    diagnostics);
  diagnostics.throw_if_errors();
  return params;
}

}  // namespace

bool traces_rays(const exec::World& world) {
  return std::ranges::any_of(world.image->code, [](const exec::Step& step) {
    return isa::effect_row(step.effect).finish == isa::Finish::Rays;
  });
}

core::Residency residency_of(const GpuParams& params, const exec::World& world) {
  return core::residency(params.core, core::CoreCell::needs_of(world, stack_bytes_per_warp(params, world)));
}

// A turn is as long as the shortest time that a message can be on its way, so the cells of a turn are
// independent of each other. Choice: other cores see stores, and atomics are done, at the end of the turn in
// which they were issued, in order of cycle and core (exec/memory_view.h). PTX leaves the order of racing
// accesses open and bounds it only by fences. A machine of one core has nobody to wait for, so its effects
// happen at issue.
TimingMachine::TimingMachine(const GpuParams& params, const exec::World& world, bool no_skip,
                             const HostOptions& host)
    : params_(checked(params, world)),
      world_(world),
      reserves_(*world.memory),
      memory_(params_.memory, params_.cores, params_.clock_mhz, &root_),
      news_lines_((params_.cores + sizeof(NewsLine) - 1) / sizeof(NewsLine)),
      endless_(*world.image),
      effects_(params_.core.livelock_budget),
      turnover_(params_.core.turnover_budget),
      engine_({.turn = memory_.shortest_latency(),
               .no_skip = no_skip,
               .threads = host.threads,
               .window = host.window,
               .homes = host.homes,
               .most_threads = most_threads(params_)}) {
  const Cycle turn = params_.cores > 1 ? memory_.shortest_latency() : 0;
  const auto reserve = [&](uint64_t bytes) { return bytes ? reserves_.take(bytes) : Address{0}; };
  const Address code = reserve(core::CoreCell::code_bytes(params_.core, world)),
                constants = reserve(core::CoreCell::constant_bytes(params_.core, world));
  const uint32_t shared_per_warp = stack_bytes_per_warp(params_, world);
  const auto table = std::make_shared<const core::IssueTable>(*world.image, params_.core);
  for (uint32_t i = 0; i < params_.cores; ++i) {
    const std::string name = fmt::format("core[{}]", i);
    rt_groups_.push_back(std::make_unique<stats::Group>(&root_, fmt::format("rt_unit[{}]", i)));
    rt::RtUnit::Context rt{*world.memory, memory_.l1(i), rt_groups_.back().get(), 0};
    if (const uint64_t bytes = rt::RtUnit::result_bytes(params_.rt)) rt.results = reserves_.take(bytes);
    if (const uint64_t bytes = core::CoreCell::table_bytes(params_.core, world))
      rt.tables = core::CoreCell::table_layout(world, reserves_.take(bytes));
    if (const uint64_t bytes = rt::RtUnit::stack_bytes_per_warp(params_.rt))
      rt.stacks = reserves_.take(bytes * core::num_warp_slots(params_.core, params_.core.warps));
    if (const uint64_t bytes = rt::RtUnit::pool_bytes(params_.rt)) rt.ray_states = reserves_.take(bytes);
    rt_units_.push_back(std::make_unique<rt::RtUnit>(params_.rt, rt));
    const Address local = reserves_.take(core::CoreCell::local_bytes(params_.core, world));
    const core::CoreCell::Context context{
        .world = world,
        .l1 = memory_.l1(i),
        .rt = *rt_units_.back(),
        .local_physical = local,
        .parent = &root_,
        .name = name,
        .no_skip = no_skip,
        .index = i,
        .cores = params_.cores,
        .clock_mhz = params_.clock_mhz,
        .tables = rt.tables.base,
        .places = {code, constants},
        .turn = turn,
        .shared_per_warp = shared_per_warp,
        .news = &news_lines_[i / sizeof(NewsLine)].bytes[i % sizeof(NewsLine)],
        .table = table};
    cores_.push_back(std::make_unique<core::CoreCell>(params_.core, context));
    access_latency_.add(cores_.back()->latencies());
    engine_.add(*cores_.back());
  }
  connect();
}

// Lets the issue policy of a core hear what the core's L1 does, if it listens.
void TimingMachine::connect_issue_policy(uint32_t i) {
  core::CoreCell& core = *cores_[i];
  if (!core.hears_l1()) return;
  mem::L1Cache& l1 = memory_.l1(i);
  core.start_l1(l1.num_lines());
  l1.read_missed().listen([&core](const mem::ReadMissed& missed) {
    if (missed.client == mem::Client::Lsu) core.tell_missed(missed.request.token, missed.request.line);
  });
  l1.line_replaced().listen([&core](const mem::LineReplaced& replaced) {
    const bool is_warps = replaced.by.client == mem::Client::Lsu;
    core.tell_replaced(replaced.place, is_warps ? std::optional(replaced.by.token) : std::nullopt,
                       replaced.victim);
  });
}

void TimingMachine::connect() {
  for (uint32_t i = 0; i < cores_.size(); ++i) connect_issue_policy(i);
  for (Cell* cell : memory_.cells()) engine_.add(*cell);
  for (ChannelBase* channel : memory_.channels()) engine_.add(*channel);
  const mem::Network::Inputs inputs = memory_.inputs();
  for (uint32_t i = 0; i < inputs.of_core.size(); ++i)
    for (ChannelBase* channel : inputs.of_core[i]) engine_.set_receiver(*channel, *cores_[i]);
  for (uint32_t i = 0; i < inputs.of_slice.size(); ++i)
    for (ChannelBase* channel : inputs.of_slice[i])
      engine_.set_receiver(*channel, memory_.partition(memory_.map().partition_of(i)));
}

Address Reserves::take(uint64_t bytes) {
  return all_.emplace_back(memory_.reserve(bytes), bytes).first;
}

void Reserves::give_back() {
  for (const auto& [first, bytes] : all_) memory_.release(first, bytes);
  all_.clear();
}

Cycle TimingMachine::run(const LaunchWatch& watch, LaunchPart* part) {
  std::vector<core::CoreCell*> cores;
  for (auto& core : cores_) cores.push_back(core.get());
  const exec::Executor executor(world_);
  const std::span<const uint32_t> blocks = part ? part->blocks() : std::span<const uint32_t>{};
  core::Dispatcher dispatcher(params_.core, executor.num_blocks(), cores, world_.in_clusters, blocks);
  const exec::Fault* fault = nullptr;
  progress_.num_warps = part ? blocks.size() * executor.warps_per_block() : executor.num_warps();
  const auto note_progress = [&](Cycle now) {
    progress_.ended_warps = uint64_t{dispatcher.num_dispatched()} * executor.warps_per_block();
    for (const auto& core : cores_) progress_.ended_warps -= core->num_resident();
    progress_.cycles = now;
  };
  const bool may_be_endless = endless_.any() && watch.max_cycles == 0,
             may_have_no_end = !watch.is_bounded && watch.max_cycles == 0;
  const auto line = [this] {
    const auto busiest = busiest_line();
    return busiest ? busiest->place : "";
  };
  Cycle next_look = 0;
  const Cycle quiet = engine_.run(
      [&](Cycle now) {
        const News news = commit_effects();
        fault = news.fault;
        if (fault) return EngineLoop::Next::Stop;
        refuse_livelock(now, news.memory_changed);
        if (may_have_no_end) refuse_endless_launch(now);
        if (const LaunchEnd end = early_end(watch, now); end != LaunchEnd::Whole) {
          note_progress(now);
          progress_.instructions = instructions();
          // A launch whose warps have all ended only waits for its last writes.
          if (progress_.ended_warps < progress_.num_warps) {
            end_ = end;
            if (const auto busiest = busiest_line()) progress_.where = busiest->to_string(*world_.image);
            return EngineLoop::Next::Stop;
          }
        }
        if (part) part->before_start(now, dispatcher.num_dispatched());
        if (news.has_room) dispatcher.dispatch(now);
        if (now >= next_look) {
          next_look = now + kLookPeriod;
          if (may_be_endless) refuse_endless_loops();
          if (watch.progress) progress_.instructions = instructions();
        }
        if (watch.progress) {
          note_progress(now);
          watch.progress(progress_, line);
        }
        return dispatcher.done() ? EngineLoop::Next::NothingMore : EngineLoop::Next::Continue;
      },
      watch.max_cycles ? watch.max_cycles : kNever);
  if (fault) throw Error(fault->exit(), passed().with(*fault));
  Cycle cycles = 0;
  for (const auto& core : cores_) cycles = std::max(cycles, core->active_until());
  if (params_.core.ends_when_written) cycles = std::min(std::max(cycles, memory_.written_until()), quiet);
  if (end_ != LaunchEnd::Whole) cycles = quiet;
  finish(quiet, cycles);
  return cycles;
}

// Lets all cores see what each has done to memory, and returns what is new.
TimingMachine::News TimingMachine::commit_effects() {
  News all;
  views_.clear();
  for (uint32_t i = 0; i < num_cores(); ++i) {
    const uint8_t news = news_lines_[i / sizeof(NewsLine)].bytes[i % sizeof(NewsLine)];
    if (news & core::CoreCell::kHasEffects) views_.push_back(cores_[i]->view());
    if (news & core::CoreCell::kHasFault && !all.fault) all.fault = &*cores_[i]->fault();
    all.has_room |= (news & core::CoreCell::kHasRoom) != 0;
  }
  all.memory_changed = exec::MemoryView::commit(views_);
  return all;
}

// Completes the statistics. A launch that was ended early leaves messages on their way, so only a whole one
// balances.
void TimingMachine::finish(Cycle quiet, Cycle cycles) {
  for (auto& core : cores_) core->finish(quiet);
  for (auto& unit : rt_units_) unit->finish(quiet);
  memory_.finish(quiet);
  reserves_.give_back();
  root_.cycles += cycles;
  root_.attributed += quiet;
  if (end_ == LaunchEnd::Whole) {
    memory_.check_drained();
    const std::string lost = broken(balances(*this));
    GLINT_CHECK(lost.empty(), "\n{}", lost);
  }
  const exec::FaultLog faults = passed();
  for (size_t kind = 0; kind < size_t(exec::FaultKind::Count); ++kind)
    root_.faults.add(exec::FaultKind(kind), faults.count(exec::FaultKind(kind)));
}

uint64_t TimingMachine::instructions() const {
  uint64_t sum = 0;
  for (const auto& core : cores_) sum += core->stats().instructions.value();
  return sum;
}

std::optional<exec::BusiestLine> TimingMachine::busiest_line() const {
  std::vector<uint32_t> pcs;
  for (const auto& core : cores_)
    core->find_warp([&](const exec::WarpContext& warp) {
      if (!warp.simt.finished()) pcs.push_back(warp.simt.pc);
      return false;
    });
  return exec::busiest_line(*world_.image, pcs);
}

void TimingMachine::refuse_endless_loops() const {
  for (const auto& core : cores_)
    if (const exec::WarpContext* warp =
            core->find_warp([&](const exec::WarpContext& one) { return endless_.holds(one.simt.pc); }))
      throw Error(Exit::Fault, passed().with(endless_.fault(world_, *warp)));
}

// Throws an error about warps that go on for ever without any effect. Most of these wait for a spin lock
// whose holder waits, too. Model: registers of warps are not looked at, so a launch that only computes for
// longer than the budget is taken for one that spins.
void TimingMachine::refuse_livelock(Cycle now, bool memory_changed) {
  effects_.look(now, memory_changed, [&] {
    uint64_t changes = 0;
    for (const auto& core : cores_) changes += core->changes();
    return changes;
  });
  if (!effects_.is_over(now)) return;
  std::string message = fmt::format(
      "the machine is stuck at cycle {}: warps run, but since cycle {} none has ended, no ray has and "
      "nothing in memory has changed\n",
      now, effects_.since());
  for (const auto& core : cores_)
    if (!core->finished()) message += core->describe_stall();
  throw Error(Exit::Stuck,
              message + "note: core.livelock_budget says how long that may last; 0 means for ever");
}

// Throws an error about warps that have an effect and come to no end: a loop that stores or traces and whose
// way out is never taken.
void TimingMachine::refuse_endless_launch(Cycle now) {
  turnover_.look(now, false, [&] {
    uint64_t turnover = 0;
    for (const auto& core : cores_) turnover += core->turnover();
    return turnover;
  });
  if (!turnover_.is_over(now)) return;
  const auto line = busiest_line();
  if (!line) return;  // The launch only waits for its last writes.
  for (const auto& core : cores_)
    if (const exec::WarpContext* warp =
            core->find_warp([&](const exec::WarpContext& one) { return one.simt.pc == line->pc; })) {
      const int lane = warp->simt.active ? std::countr_zero(warp->simt.active) : 0;
      exec::Fault fault{fmt::format("no end in sight: for {} cycles no warp has begun or ended, and {}",
                                    params_.core.turnover_budget, line->to_string(*world_.image)),
                        world_.image->place_of(line->pc), exec::shader_thread_id(*warp, lane)};
      throw Error(Exit::Fault,
                  passed().with(fault) +
                      "\n  note: --set core.turnover_budget=CYCLES allows more cycles; 0 allows any number");
    }
}

exec::FaultLog TimingMachine::passed() const {
  exec::FaultLog all;
  for (const auto& core : cores_) all.add(core->passed());
  return all;
}

// Stores of one cycle took effect in the order of their cores.
exec::NotFiniteStores TimingMachine::not_finite_stores() const {
  exec::NotFiniteStores all;
  for (const auto& core : cores_) all.add(std::as_const(*core).executor().not_finite_stores());
  return all;
}

void TimingMachine::collect(RenderResult& result) const {
  result.residency = residency_of(params_, world_);
  for (const auto& core : cores_) {
    const core::CoreStats& stats = core->stats();
    for (size_t c = 0; c < size_t(isa::Class::Count); ++c) {
      result.by_class[c].instructions += stats.by_class.count(isa::Class(c));
      result.by_class[c].lanes += stats.lanes_by_class.count(isa::Class(c));
      result.by_class[c].latency += stats.latency.count(isa::Class(c));
    }
  }
  for (const auto& unit : rt_units_) {
    const rt::RtStats& stats = unit->stats();
    result.rays.rays += stats.rays.value();
    result.rays.nodes += stats.nodes.value();
    result.rays.box_tests += stats.box_tests.value();
    result.rays.triangle_tests += stats.triangle_tests.value();
  }
}

}  // namespace glint::pipeline
