// Makes maps from the costs of threads, and charges misses of the L1.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/run_costs.h"

#include <utility>

#include "base/num_lanes.h"
#include "pipeline/timing_machine.h"

namespace glint::pipeline {
namespace {

// Charges a miss equally to the lanes that the read is for, whichever warps they belong to.
void charge_miss(const mem::ReadMissed& missed, const core::CoreCell& core, const rt::RtUnit& rt,
                 core::CostRecorder& recorder) {
  if (missed.client == mem::Client::Lsu) {
    uint32_t slot = 0;
    const LaneMask lanes = core.readers_of(missed.request.token, missed.request.line, slot);
    recorder.miss(slot, lanes, int(num_lanes(lanes)));
  } else if (missed.client == mem::Client::RtUnit) {
    int all = 0;
    rt.for_each_reader(missed.request.token, [&](uint32_t, LaneMask lanes) { all += int(num_lanes(lanes)); });
    rt.for_each_reader(missed.request.token,
                       [&](uint32_t slot, LaneMask lanes) { recorder.miss(slot, lanes, all); });
  }
}

struct MapKind {
  const char *name, *unit, *doc;
  bool needs_timing, is_count;
  double (*of)(const core::ThreadCost& sum);
};
constexpr MapKind kKinds[] = {
    {"cycles", "cycle",
     "Cycles from the pixel's first instruction to its last, as a shader that reads its clock at both would "
     "measure them. Waits for other lanes are included.",
     true, true, [](const core::ThreadCost& c) { return double(c.cycles); }},
    {"active_cycles", "cycle",
     "Cycles from an instruction that the pixel executed to the next one of its warp.", true, true,
     [](const core::ThreadCost& c) { return double(c.active_cycles); }},
    {"instructions", "instruction", "Number of instructions that the pixel executed.", false, true,
     [](const core::ThreadCost& c) { return double(c.instructions); }},
    {"divergence", "fraction",
     "Idle fraction of the lane slots that the pixel's instructions took. Each slot is shared by the lanes "
     "that execute it.",
     false, false,
     [](const core::ThreadCost& c) { return c.slots > 0 ? 1.0 - double(c.instructions) / c.slots : 0.0; }},
    {"rays", "ray", "Number of rays traced, including ray queries.", false, true,
     [](const core::ThreadCost& c) { return double(c.rays); }},
    {"nodes", "node", "Number of nodes and leaves that the pixel's rays visited.", false, true,
     [](const core::ThreadCost& c) { return double(c.nodes); }},
    {"triangle_tests", "test", "Number of ray-triangle tests.", false, true,
     [](const core::ThreadCost& c) { return double(c.triangle_tests); }},
    {"any_hit_calls", "call", "Number of any-hit shaders begun.", false, true,
     [](const core::ThreadCost& c) { return double(c.any_hit_calls); }},
    {"intersection_calls", "call", "Number of intersection shaders begun.", false, true,
     [](const core::ThreadCost& c) { return double(c.intersection_calls); }},
    {"l1_misses", "request", "Number of L1 reads that missed. Each is shared by the lanes that it is for.",
     true, false, [](const core::ThreadCost& c) { return c.l1_misses; }},
};

void add(core::ThreadCost& sum, const core::ThreadCost& more) {
  for (const auto counter :
       {&core::ThreadCost::cycles, &core::ThreadCost::active_cycles, &core::ThreadCost::instructions,
        &core::ThreadCost::rays, &core::ThreadCost::nodes, &core::ThreadCost::triangle_tests,
        &core::ThreadCost::any_hit_calls, &core::ThreadCost::intersection_calls})
    sum.*counter += more.*counter;
  sum.slots += more.slots;
  sum.l1_misses += more.l1_misses;
}

}  // namespace

std::vector<std::unique_ptr<core::CostRecorder>> record_costs(TimingMachine& machine,
                                                              core::LaunchCosts& costs) {
  std::vector<std::unique_ptr<core::CostRecorder>> recorders;
  for (uint32_t i = 0; i < machine.num_cores(); ++i) {
    core::CoreCell& core = machine.core(i);
    recorders.push_back(std::make_unique<core::CostRecorder>(costs, core.num_slots()));
    core::CostRecorder& recorder = *recorders.back();
    core.observe(recorder);
    machine.memory().l1(i).read_missed().listen(
        [&core, &recorder, &rt = machine.rt_unit(i)](const mem::ReadMissed& missed) {
          charge_miss(missed, core, rt, recorder);
        });
  }
  return recorders;
}

std::vector<CostMap> cost_maps(const core::LaunchCosts& costs, bool timing) {
  const size_t pixels = size_t{costs.width()} * costs.height();
  std::vector<core::ThreadCost> sums(pixels);
  for (size_t i = 0; i < costs.threads().size(); ++i) add(sums[i % pixels], costs.threads()[i]);
  std::vector<CostMap> maps;
  for (const MapKind& kind : kKinds) {
    if (kind.needs_timing && !timing) continue;
    CostMap map{kind.name, kind.unit, kind.doc, kind.is_count, costs.width(), costs.height(), {}};
    map.values.reserve(pixels);
    for (const core::ThreadCost& sum : sums) map.values.push_back(kind.of(sum));
    maps.push_back(std::move(map));
  }
  return maps;
}

}  // namespace glint::pipeline
