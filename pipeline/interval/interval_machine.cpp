// Makes the functional pass: it takes the warps of all cores in order of time, and runs one interval of a
// warp at once.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/interval/interval_machine.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/num_lanes.h"
#include "core/coalesce.h"
#include "core/core_cell.h"
#include "core/residency.h"

namespace glint::pipeline {

using core::Finish;
using isa::Effect;
using isa::Space;

namespace {

// Cores take turns of this many cycles, which is short compared with a miss and long compared with an event.
constexpr Cycle kTurn = 48;

// Refuses everything that the model would silently pass over, all at once.
const exec::World& checked(const GpuParams& params, const exec::World& world) {
  const rt::Params& rt = params.rt;
  const std::pair<bool, std::string_view> unknown[] = {
      {world.block_size[0] != 0, "launches with blocks of threads"},
      {rt.unit != rt::kHardware, "rays that code walks (rt.unit = \"software\")"},
      {rt.result_store || rt.shortcuts.fetch_headers || rt.shortcuts.fetch_descriptors ||
           rt.shortcuts.store_each_hit,
       "rt.result_store and the accesses of rt.shortcuts"},
      {params.core.local_by_thread, "rays in memory (core.local_by_thread)"},
      {rt.oracle.fetch_hits || rt.oracle.any_lane, "rt.oracle"},
      {!params.core.fetch.perfect || !params.core.constant.perfect,
       "caches of instructions and constants (core.fetch.perfect = false or core.constant.perfect = false)"}};
  std::string message;
  for (const auto& [is_there, what] : unknown)
    if (is_there) message += fmt::format("the interval model does not know {}\n", what);
  const auto check_policy = [&message](std::string_view key, const auto& choice) {
    if (!choice.is_in_interval_model())
      message += fmt::format("the interval model does not know {} = \"{}\"\n", key, choice.name);
  };
  check_policy("core.reorder", params.core.reorder);
  check_policy("rt.any_hit", rt.any_hit);
  check_policy("rt.scheduler", rt.scheduler);
  check_policy("rt.coalescing", rt.coalescing);
  check_policy("rt.order", rt.order);
  check_policy("rt.stack", rt.stack);
  check_policy("rt.mapping", rt.mapping);
  check_policy("rt.entry", rt.entry);
  check_policy("rt.leaf_filter", rt.leaf_filter);
  check_policy("rt.prefetch", rt.prefetch);
  check_policy("memory.noc.topology", params.memory.noc.topology);
  if (!message.empty())
    throw UnsupportedError(message + "  note: `glint model --statistics-only` leaves it out");
  return world;
}

}  // namespace

struct IntervalMachine::Core {
  Core(const GpuParams& params, const exec::World& world, MemoryModel& memory, uint32_t core_index,
       uint32_t slots)
      : index(core_index),
        rays(params.rt, *world.memory, memory, core_index),
        warps(slots),
        issue(params.core.schedulers),
        lines(params.memory.line),
        local(core::CoreCell::local_layout(
            params.core, world, world.memory->reserve(core::CoreCell::local_bytes(params.core, world)))) {}

  uint32_t index;
  RayModel rays;
  std::vector<exec::WarpContext> warps;  // indexed by slot
  std::vector<Cycle> issue;              // cycle in which each scheduler has issued all that it was given
  double issue_work = 0;
  core::LineList lines;
  core::LocalLayout local;
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events;
  // Holds the cycles in which the registers of the running warp are ready.
  std::array<Cycle, core::kScoreboardEntries> ready{};
};

IntervalMachine::IntervalMachine(const GpuParams& params, const exec::World& world)
    : params_(params),
      world_(checked(params, world)),
      executor_(world),
      table_(*world.image, params.core),
      memory_(params.memory, params.cores, params.clock_mhz) {
  const uint32_t slots = core::residency(params.core, core::CoreCell::needs_of(world)).warps;
  for (uint32_t i = 0; i < params.cores; ++i)
    cores_.push_back(std::make_unique<Core>(params, world, memory_, i, slots));
}

IntervalMachine::~IntervalMachine() = default;

// Launches the next warp, if there is one left.
bool IntervalMachine::launch(Core& core, uint32_t slot, Cycle at) {
  if (next_warp_ == executor_.num_warps()) return false;
  executor_.start(core.warps[slot], next_warp_++);
  run_interval(core, slot, at + params_.core.warp_launch_latency);
  return true;
}

// Runs a warp from `at` up to its next rays or its end, as if it were alone with its caches.
void IntervalMachine::run_interval(Core& core, uint32_t slot, Cycle at) {
  exec::WarpContext& warp = core.warps[slot];
  core.ready.fill(0);
  std::array<double, core::kNumPipes> pipe_free{}, work{};
  double slots = 0;
  Cycle now = at;
  bool finished = false;
  while (!finished && !warp.waiting_for_rays) {
    const uint32_t pc = warp.simt.pc;
    const core::IssueRow& row = table_.row(pc);
    for (const uint16_t use : table_.uses(row)) now = std::max(now, core.ready[use]);
    now = std::max(now, Cycle(pipe_free[size_t(row.pipe)]));
    const exec::Issued issued = executor_.execute(warp, now);
    if (executor_.fault())
      throw Error(executor_.fault()->exit(), executor_.passed().with(*executor_.fault()));
    if (warp.instructions > params_.core.instruction_budget) [[unlikely]]
      throw Error(Exit::Fault, executor_.passed().with(
                                   exec::no_end_in_sight(world_, warp, pc, params_.core.instruction_budget)));
    finished = issued.finished;
    ++estimate_.instructions;
    estimate_.lanes += num_lanes(issued.lanes);
    slots += table_.issues(pc);
    const double interval = double(row.interval) / core::OpTime::kParts;
    pipe_free[size_t(row.pipe)] = double(now) + interval;
    work[size_t(row.pipe)] += interval;
    Cycle done = now + row.latency;
    if (row.finish == Finish::Memory || row.finish == Finish::CallRecord)
      done = access(core, slot, issued, row, now);
    for (const uint16_t def : table_.defs(row)) core.ready[def] = done;
    const bool holds = row.finish == Finish::Control || row.finish == Finish::CallRecord ||
                       row.finish == Finish::Fence || row.finish == Finish::Barrier;
    now = holds ? done : now + table_.issues(pc);
  }
  // The scheduler has to issue the work of its other warps first. It issues one instruction per cycle, and
  // each pipe has its interval.
  Cycle& issue = core.issue[slot % core.issue.size()];
  const double busy = std::max(slots, *std::ranges::max_element(work));
  issue = std::max(issue, at) + Cycle(busy);
  core.issue_work += slots / double(core.issue.size());
  core.events.push({std::max(now, issue), slot, finished});
}

// Returns when the data that an instruction loads are there. What it stores costs the warp nothing more.
Cycle IntervalMachine::access(Core& core, uint32_t slot, const exec::Issued& issued,
                              const core::IssueRow& row, Cycle at) {
  core.lines.clear();
  const isa::Access& addresses = core.warps[slot].regs.access;
  const auto bytes = uint32_t(issued.row->memory.bytes * issued.row->memory.count);
  const Cycle begin = at + (row.is_texture ? params_.core.units.tex : params_.core.units.lsu).latency;
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
  }
  const bool is_write = isa::only_writes_memory(issued.row->effect);
  Cycle done = std::max<Cycle>(begin, at + row.latency);
  Cycle sent = begin;
  for (const core::LineSectors& line : core.lines.lines()) {
    if (is_write)
      memory_.write(core.index, line.line, line.sectors, sent, local != 0);
    else
      done = std::max(done, memory_.read(core.index, line.line, line.sectors, sent, Asker::Shader));
    ++sent;
  }
  return done;
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
    if (!event.finished) {
      core.rays.submit(event.at + params_.core.units.rt_unit.latency, event.slot, core.warps[event.slot]);
    } else {
      end_ = std::max(end_, event.at);
      ++num_ended_;
      launch(core, event.slot, event.at);
    }
  }
  for (const auto& [slot, at] : core.rays.take_done()) {
    executor_.finish_rays(core.warps[slot]);
    run_interval(core, slot, at + 1);
  }
}

IntervalEstimate IntervalMachine::run(const std::function<void(uint64_t, uint64_t)>& progress) {
  const uint32_t slots = uint32_t(cores_[0]->warps.size());
  for (uint32_t slot = 0; slot < slots; ++slot)  // one warp per core in turn, as the dispatcher does
    for (const auto& core : cores_) launch(*core, slot, params_.core.launch_latency);
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
  out.cycles = end_;
  for (const auto& core : cores_) {
    const RayModelCounts& rays = core->rays.counts();
    out.rays.rays += rays.rays;
    out.rays.nodes += rays.nodes;
    out.rays.requests += rays.requests;
    out.rays.traces += rays.traces;
    out.rays.trace_cycles += rays.trace_cycles;
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
