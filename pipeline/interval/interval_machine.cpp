// Makes the functional pass: it takes the warps of all cores in order of time, and runs one interval of a
// warp at once.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/interval/interval_machine.h"

#include <algorithm>
#include <fmt/format.h>
#include <string>

#include "base/num_lanes.h"
#include "pipeline/interval/interval_core.h"

namespace glint::pipeline {

using core::Finish;

namespace {

// Cores take turns of this many cycles, which is short compared with a miss and long compared with an event.
constexpr Cycle kTurn = 48;
// In launches with blocks, an interval ends where the warp would wait past this many cycles. Then accesses
// and barriers of a core's warps come nearly in order of time.
constexpr Cycle kInterval = 48;

void note_policy(std::string& message, std::string_view key, const auto& choice) {
  if (!choice.is_in_interval_model())
    message += fmt::format("the interval model does not know {} = \"{}\"\n", key, choice.name);
}

// Returns what the model lacks of the RT unit.
std::string unknown_of_rays(const GpuParams& params) {
  const rt::Params& rt = params.rt;
  const std::pair<bool, std::string_view> unknown[] = {
      {rt.unit != rt::kHardware, "rays that code walks (rt.unit = \"software\")"},
      {rt.result_store || rt.shortcuts.fetch_headers || rt.shortcuts.fetch_descriptors ||
           rt.shortcuts.store_each_hit,
       "rt.result_store and the accesses of rt.shortcuts"},
      {rt.oracle.fetch_hits || rt.oracle.any_lane, "rt.oracle"}};
  std::string message;
  for (const auto& [is_there, what] : unknown)
    if (is_there) message += fmt::format("the interval model does not know {}\n", what);
  const auto check_policy = [&message](std::string_view key, const auto& choice) {
    note_policy(message, key, choice);
  };
  check_policy("rt.any_hit", rt.any_hit);
  check_policy("rt.scheduler", rt.scheduler);
  check_policy("rt.coalescing", rt.coalescing);
  check_policy("rt.order", rt.order);
  check_policy("rt.stack", rt.stack);
  check_policy("rt.mapping", rt.mapping);
  check_policy("rt.entry", rt.entry);
  check_policy("rt.leaf_filter", rt.leaf_filter);
  check_policy("rt.prefetch", rt.prefetch);
  return message;
}

bool traces_rays(const exec::Image& image) {
  return std::ranges::any_of(image.code,
                             [](const exec::Step& step) { return step.row->klass == isa::Class::Rt; });
}

// Refuses everything that the model would silently pass over, all at once.
const exec::World& checked(const GpuParams& params, const exec::World& world) {
  std::string message;
  if (params.core.local_by_thread)
    message += "the interval model does not know rays in memory (core.local_by_thread)\n";
  if (!params.core.fetch.perfect || !params.core.constant.perfect)
    message +=
        "the interval model does not know caches of instructions and constants (core.fetch.perfect = false "
        "or core.constant.perfect = false)\n";
  note_policy(message, "core.reorder", params.core.reorder);
  note_policy(message, "memory.noc.topology", params.memory.noc.topology);
  if (traces_rays(*world.image)) message += unknown_of_rays(params);
  if (!message.empty()) throw UnsupportedError(message);
  return world;
}

}  // namespace

IntervalMachine::IntervalMachine(const GpuParams& params, const exec::World& world)
    : IntervalMachine(params, world,
                      std::make_unique<MemoryModel>(params.memory, params.cores, params.clock_mhz), nullptr,
                      0) {
}

IntervalMachine::IntervalMachine(const GpuParams& params, const exec::World& world, MemoryModel& memory,
                                 Cycle begin)
    : IntervalMachine(params, world, nullptr, &memory, begin) {
}

IntervalMachine::IntervalMachine(const GpuParams& params, const exec::World& world,
                                 std::unique_ptr<MemoryModel> own, MemoryModel* memory, Cycle begin)
    : params_(params),
      world_(checked(params, world)),
      has_blocks_(world.block_size[0] != 0),
      executor_(world),
      table_(*world.image, params.core),
      own_memory_(std::move(own)),
      memory_(memory ? *memory : *own_memory_),
      reserves_(*world.memory),
      begin_(begin),
      end_(begin) {
  const core::Residency residency = core::residency(params.core, core::CoreCell::needs_of(world));
  for (uint32_t i = 0; i < params.cores; ++i)
    cores_.push_back(std::make_unique<Core>(params, world, memory_, i, residency,
                                            reserves_.take(core::CoreCell::local_bytes(params.core, world))));
}

IntervalMachine::~IntervalMachine() = default;

// Launches the next block, or warp of a launch without blocks, if there is one left.
bool IntervalMachine::launch(Core& core, uint32_t place, Cycle at) {
  if (next_block_ == executor_.num_blocks()) return false;
  const Cycle begin = at + params_.core.warp_launch_latency;
  if (!has_blocks_) {
    executor_.start(core.warps[place].context, next_block_++);
    run_interval(core, place, begin);
    return true;
  }
  executor_.start(core.blocks[place], next_block_++);
  const uint32_t warps = core.left[place] = executor_.warps_per_block();
  for (uint32_t i = 0; i < warps; ++i) {
    const uint32_t slot = place * warps + i;
    Core::Warp& warp = core.warps[slot];
    executor_.start(warp.context, core.blocks[place], i,
                    {slot, uint32_t(core.warps.size()), core.index, params_.cores});
    warp.ready.fill(0);
    warp.copied = 0;
    core.events.push({begin, slot, Next::Run});
  }
  return true;
}

// Runs a warp from `at` up to its next wait or its end, as if it were alone with its caches.
void IntervalMachine::run_interval(Core& core, uint32_t slot, Cycle at) {
  if (!has_blocks_) core.warps[slot].ready.fill(0);
  slots_ = 0;
  work_ = {};
  Cycle now = at;
  const Next next = execute(core, slot, now, has_blocks_ ? at + kInterval : kNever);
  // The scheduler has to issue the work of its other warps first. It issues one instruction per cycle, and
  // each pipe has its interval.
  Cycle& issue = core.issue[slot % core.issue.size()];
  issue = std::max(issue, at) + Cycle(std::max(slots_, *std::ranges::max_element(work_)));
  core.issue_work += slots_ / double(core.issue.size());
  if (next == Next::Barrier)
    come_to_barrier(core, slot, std::max(now, issue));
  else
    core.events.push({std::max(now, issue), slot, next});
}

// Executes up to the next wait. `now` becomes the cycle from which the warp could go on.
IntervalMachine::Next IntervalMachine::execute(Core& core, uint32_t slot, Cycle& now, Cycle until) {
  exec::WarpContext& warp = core.warps[slot].context;
  std::array<Cycle, core::kScoreboardEntries>& ready = core.warps[slot].ready;
  std::array<double, core::kNumPipes> pipe_free{};
  for (;;) {
    const uint32_t pc = warp.simt.pc;
    const core::IssueRow& row = table_.row(pc);
    for (const uint16_t use : table_.uses(row)) now = std::max(now, ready[use]);
    now = std::max(now, Cycle(pipe_free[size_t(row.pipe)]));
    if (now > until) return Next::Run;
    const exec::Issued issued = executor_.execute(warp, now);
    if (executor_.fault())
      throw Error(executor_.fault()->exit(), executor_.passed().with(*executor_.fault()));
    if (warp.instructions > params_.core.instruction_budget) [[unlikely]]
      throw Error(Exit::Fault, executor_.passed().with(
                                   exec::no_end_in_sight(world_, warp, pc, params_.core.instruction_budget)));
    ++estimate_.instructions;
    estimate_.lanes += num_lanes(issued.lanes);
    slots_ += table_.issues(pc);
    const double interval = double(row.interval) / core::OpTime::kParts;
    pipe_free[size_t(row.pipe)] = double(now) + interval;
    work_[size_t(row.pipe)] += interval;
    Cycle done = now + row.latency;
    if (row.finish == Finish::Memory || row.finish == Finish::CallRecord)
      done = access(core, slot, issued, row, now);
    // Model: cp.async.wait_group waits for all copies of the warp.
    if (issued.row->effect == isa::Effect::Copy)
      core.warps[slot].copied = std::max(core.warps[slot].copied, done);
    if (row.finish == Finish::Copies) done = std::max(now, core.warps[slot].copied) + row.latency;
    for (const uint16_t def : table_.defs(row)) ready[def] = done;
    const bool holds = row.finish == Finish::Control || row.finish == Finish::CallRecord ||
                       row.finish == Finish::Fence || row.finish == Finish::Copies ||
                       (row.finish == Finish::Barrier && !has_blocks_);
    now = holds ? done : now + table_.issues(pc);
    if (issued.finished) return Next::End;
    if (warp.waiting_for_rays) return Next::Rays;
    if (row.finish == Finish::Barrier && has_blocks_) return Next::Barrier;
  }
}

// Takes a warp that has executed a bar.* into the barrier unit, which takes one after another.
void IntervalMachine::come_to_barrier(Core& core, uint32_t slot, Cycle at) {
  Core::Warp& warp = core.warps[slot];
  core.barrier = std::max(core.barrier, at) + params_.core.units.barrier.interval;
  warp.arrived = core.barrier;
  warp.waits = true;
  pass_barrier(core, slot, core.barrier);
}

// Lets the warps of a block go on whose barrier has opened when warp `slot` came to it or ended at `at`. The
// pass may have executed the last warp to come before one that it lets wait, so the latest of them counts.
void IntervalMachine::pass_barrier(Core& core, uint32_t slot, Cycle at) {
  const uint32_t warps = executor_.warps_per_block(), first = slot / warps * warps;
  const auto goes_on = [&](const Core::Warp& warp) { return warp.waits && !warp.context.waiting_at_barrier; };
  Cycle latest = at;
  for (uint32_t i = first; i < first + warps; ++i)
    if (goes_on(core.warps[i])) latest = std::max(latest, core.warps[i].arrived);
  for (uint32_t i = first; i < first + warps; ++i) {
    if (!goes_on(core.warps[i])) continue;
    core.warps[i].waits = false;
    core.events.push({latest + params_.core.units.barrier.latency, i, Next::Run});
  }
}

void IntervalMachine::end_warp(Core& core, uint32_t slot, Cycle at) {
  end_ = std::max(end_, at);
  ++num_ended_;
  if (!has_blocks_) {
    launch(core, slot, at);
    return;
  }
  const uint32_t place = slot / executor_.warps_per_block();
  if (--core.left[place] == 0)
    launch(core, place, at);
  else
    pass_barrier(core, slot, at);
}

Cycle IntervalMachine::next(const Core& core) const {
  return std::min(core.events.empty() ? kNever : core.events.top().at, core.rays.next());
}

// Handles the first event that is due on a core.
void IntervalMachine::advance(Core& core) {
  if (core.events.empty() || core.rays.next() < core.events.top().at) {
    core.rays.advance();
  } else {
    const Event event = core.events.top();
    core.events.pop();
    if (event.next == Next::Run)
      run_interval(core, event.slot, event.at);
    else if (event.next == Next::Rays)
      core.rays.submit(event.at + params_.core.units.rt_unit.latency, event.slot,
                       core.warps[event.slot].context);
    else
      end_warp(core, event.slot, event.at);
  }
  for (const auto& [slot, at] : core.rays.take_done()) {
    executor_.finish_rays(core.warps[slot].context);
    run_interval(core, slot, at + 1);
  }
}

IntervalEstimate IntervalMachine::run(const std::function<void(uint64_t, uint64_t)>& progress) {
  const uint32_t places = uint32_t(cores_[0]->blocks.size());
  for (uint32_t place = 0; place < places; ++place)  // one block per core in turn, as the dispatcher does
    for (const auto& core : cores_) launch(*core, place, begin_ + params_.core.launch_latency);
  for (Cycle now = 0; now != kNever;) {
    now = kNever;
    for (const auto& core : cores_) now = std::min(now, next(*core));
    if (now == kNever) break;
    const Cycle turn = (now / kTurn + 1) * kTurn;
    for (const auto& core : cores_)
      while (next(*core) < turn) advance(*core);
    if (progress) progress(num_ended_, executor_.num_warps());
  }
  return collect();
}

IntervalEstimate IntervalMachine::collect() const {
  IntervalEstimate out = estimate_;
  out.cycles = end_ - begin_;
  for (const auto& core : cores_) {
    const RayModelCounts& rays = core->rays.counts();
    out.rays.add(rays);
    out.issue = std::max(out.issue, core->issue_work);
    out.rt_port = std::max(out.rt_port, core->rays.port_work());
    out.rt_tests = std::max(out.rt_tests, core->rays.test_work());
    out.rt_slots = std::max(out.rt_slots, double(rays.trace_cycles) / params_.rt.warps);
  }
  out.l1 = memory_.l1();
  out.l2 = memory_.l2();
  out.dram_sectors = memory_.dram_sectors();
  out.l1_ports = memory_.l1_work();
  out.l2_slices = memory_.l2_work();
  out.dram_buses = memory_.dram_work();
  return out;
}

IntervalEstimate IntervalDevice::run(const exec::World& world, bool warm) {
  memory_.begin_launch(!warm);
  IntervalMachine machine(params_, world, memory_, now_);
  const IntervalEstimate out = machine.run({});
  now_ += out.cycles;
  sum_.add(out);
  return out;
}

void IntervalEstimate::add(const IntervalEstimate& later) {
  cycles += later.cycles;
  instructions += later.instructions;
  lanes += later.lanes;
  rays.add(later.rays);
  issue += later.issue, rt_port += later.rt_port, rt_tests += later.rt_tests, rt_slots += later.rt_slots;
  l1 = later.l1, l2 = later.l2, dram_sectors = later.dram_sectors;
  l1_ports = later.l1_ports, l2_slices = later.l2_slices, dram_buses = later.dram_buses;
}

std::array<std::pair<std::string_view, double>, 7> IntervalEstimate::bounds() const {
  return {{{"issue slots", issue},
           {"RT warps", rt_slots},
           {"RT request port", rt_port},
           {"RT test pipes", rt_tests},
           {"L1 port", l1_ports},
           {"L2 slice", l2_slices},
           {"DRAM bus", dram_buses}}};
}

}  // namespace glint::pipeline
