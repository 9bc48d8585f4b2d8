// Reads the counters of a timing machine.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/batch_counts.h"

#include <fmt/format.h>

#include "pipeline/timing_machine.h"

namespace glint::pipeline {
namespace {

template <class Reason>
double all_of(const stats::Breakdown<Reason>& breakdown) {
  return double(breakdown.total());
}

}  // namespace

BatchCounts counts_of(const TimingMachine& machine, Cycle now) {
  BatchCounts out{};
  const auto add = [&](BatchCount which, double count) { out[size_t(which)] += count; };
  add(BatchCount::Cycles, double(now));
  for (uint32_t i = 0; i < machine.num_cores(); ++i) {
    add(BatchCount::Instructions, double(machine.core(i).stats().instructions.value()));
    add(BatchCount::Nodes, double(machine.rt_unit(i).stats().nodes.value()));
    const mem::CacheStats& l1 = machine.memory().l1(i).stats();
    add(BatchCount::L1Reads, all_of(l1.reads));
    add(BatchCount::L1Hits, all_of(l1.hits));
  }
  for (uint32_t i = 0; i < machine.memory().num_partitions(); ++i) {
    const mem::Partition& partition = machine.memory().partition(i);
    for (uint32_t slice = 0; slice < partition.num_slices(); ++slice) {
      add(BatchCount::L2Reads, all_of(partition.slice(slice).stats().reads));
      add(BatchCount::L2Hits, all_of(partition.slice(slice).stats().hits));
    }
    const mem::DramStats& dram = partition.dram().stats();
    add(BatchCount::DramClocks, double(dram.clocks.value()));
    add(BatchCount::DramBusy, double(dram.busy_clocks.value()));
  }
  return out;
}

std::string batch_columns() {
  return "cycles,instructions,nodes,l1_reads,l1_hits,l2_reads,l2_hits,dram_clocks,dram_busy";
}

std::string batch_cells(const BatchCounts& counts) {
  std::string out;
  for (const double count : counts) out += fmt::format(",{}", count);
  return out;
}

}  // namespace glint::pipeline
