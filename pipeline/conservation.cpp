// Computes the balances of cores, RT units and partitions.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/conservation.h"

#include <fmt/format.h>
#include <string_view>
#include <utility>

#include "pipeline/timing_machine.h"

namespace glint::pipeline {
namespace {

class Ledger {
 public:
  explicit Ledger(std::string unit) : unit_(std::move(unit)) {}
  void equal(std::string_view what, uint64_t left, uint64_t right) {
    rows.push_back({fmt::format("{}: {}", unit_, what), left, right});
  }
  std::vector<Balance> rows;

 private:
  const std::string unit_;
};

std::vector<Balance> of_core(const core::CoreCell& core, uint64_t cycles, uint32_t schedulers) {
  const core::CoreStats& s = core.stats();
  Ledger ledger(s.name());
  ledger.equal("attributed issue slots = schedulers x cycles", s.stalls.total(), cycles * schedulers);
  ledger.equal("slots that issued = instructions", s.stalls.count(core::Stall::Issued),
               s.instructions.value() + s.sequence_slots.value());
  uint64_t by_stage = 0;
  for (const core::StageStats* stage : s.stage) by_stage += stage->instructions.total();
  ledger.equal("instructions by stage = instructions", by_stage, s.instructions.value());
  ledger.equal("instructions by class = instructions", s.by_class.total(), s.instructions.value());
  for (size_t i = 0; i < size_t(isa::Class::Count); ++i) {
    uint64_t latency = 0;
    for (const core::StageStats* stage : s.stage) latency += stage->latency.count(isa::Class(i));
    ledger.equal(fmt::format("latency of {} by stage = latency", name_of(isa::Class(i))), latency,
                 s.latency.count(isa::Class(i)));
  }
  ledger.equal("warps left = none", core.num_resident(), 0);
  return std::move(ledger.rows);
}

// Returns the balances of the profile, if there is one: what it adds up to, and what the core counts.
std::vector<Balance> of_profile(const core::CoreCell& core) {
  const core::CoreStats& s = core.stats();
  Ledger ledger(s.name() + " profile");
  const core::Profile* profile = core.profile();
  if (!profile) return {};
  core::InstructionCounts sum = profile->nowhere();
  for (uint32_t pc = 0; pc < profile->num_instructions(); ++pc) {
    const core::InstructionCounts& counts = profile->of(pc);
    sum += counts;
    for (size_t i = 0; i < sum.slots.size(); ++i) sum.slots[i] += counts.slots[i];
  }
  ledger.equal("issues = instructions", sum.issues, s.instructions.value());
  ledger.equal("lanes = lane instructions", sum.lanes, s.lane_instructions.value());
  ledger.equal("requests = lines", sum.requests, s.lines.value());
  ledger.equal("sectors = sectors", sum.sectors, s.sectors.value());
  for (size_t i = 0; i < sum.slots.size(); ++i)
    ledger.equal(fmt::format("slots of {}", name_of(core::Stall(i))), sum.slots[i],
                 s.stalls.count(core::Stall(i)));
  return std::move(ledger.rows);
}

std::vector<Balance> of_rays(const core::CoreStats& core, const rt::RtUnit& unit, uint64_t cycles) {
  const rt::RtStats& s = unit.stats();
  Ledger ledger(core.name() + " RT unit");
  ledger.equal("attributed cycles = cycles", s.cycles.total(), cycles);
  ledger.equal("warps in = warps handed over", s.warps.value(), core.rt_warps.value());
  ledger.equal("rays in = rays handed over", s.rays.value() + s.resumed.value(), core.rt_lanes.value());
  ledger.equal("rays in = rays out", s.rays.value() + s.resumed.value(),
               s.finished.value() + s.suspended.value());
  ledger.equal("rays by nodes = rays", s.ray_nodes.total(), s.rays.value());
  ledger.equal("rays by time = rays", s.ray_latency.total(), s.rays.value());
  ledger.equal("warps left = none", unit.num_resident(), 0);
  return std::move(ledger.rows);
}

std::vector<Balance> of_partition(uint32_t index, const mem::Partition& partition, uint64_t cycles) {
  const mem::DramStats& dram = partition.dram().stats();
  Ledger ledger(fmt::format("partition[{}]", index));
  for (uint32_t i = 0; i < partition.num_slices(); ++i)
    ledger.equal("attributed cycles = cycles", partition.slice(i).stats().cycles.total(), cycles);
  ledger.equal("DRAM requests = reads + writes", dram.requests.value(),
               dram.reads.value() + dram.writes.value());
  ledger.equal("attributed DRAM clocks = clocks", dram.use.total(), dram.clocks.value());
  return std::move(ledger.rows);
}

}  // namespace

std::vector<Balance> balances(const TimingMachine& machine) {
  std::vector<Balance> out;
  const auto add = [&](std::vector<Balance> rows) { out.insert(out.end(), rows.begin(), rows.end()); };
  const uint64_t cycles = machine.attributed_cycles();
  for (uint32_t i = 0; i < machine.num_cores(); ++i) {
    const core::CoreCell& core = machine.core(i);
    add(of_core(core, cycles, machine.params().core.schedulers));
    add(of_profile(core));
    add(of_rays(core.stats(), machine.rt_unit(i), cycles));
  }
  for (uint32_t i = 0; i < machine.memory().num_partitions(); ++i)
    add(of_partition(i, machine.memory().partition(i), cycles));
  return out;
}

std::string broken(const std::vector<Balance>& balances) {
  std::string out;
  for (const Balance& b : balances)
    if (b.left != b.right) out += fmt::format("{}: {} against {}\n", b.what, b.left, b.right);
  return out;
}

}  // namespace glint::pipeline
