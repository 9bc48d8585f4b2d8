// Makes the tables of a profile and of a time series from the counters of cores and partitions.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/run_profile.h"

#include <algorithm>
#include <utility>

#include "isa/text.h"
#include "pipeline/timing_machine.h"

namespace glint::pipeline {
namespace {

void add(ProfileRow& row, const core::InstructionCounts& counts) {
  row.add(counts, counts.slots);
}

ProfileRow row_of(const exec::Image& image, uint32_t pc, size_t reasons) {
  const exec::Shader& shader = image.shaders[image.shader_of[pc]];
  const isa::Line& line = image.lines[pc];
  ProfileRow row;
  row.shader = shader.name;
  row.stage = isa::name_of(shader.stage);
  row.file = line.file < image.files.size() ? image.files[line.file] : "";
  row.line = line.line;
  row.index = pc - shader.entry;
  row.op = image.code[pc].row->name;
  row.program = image.shader_of[pc];
  row.spirv = line.spirv;
  row.scope = line.scope;
  row.slots.resize(reasons);
  return row;
}

ProgramListing listing_of(const isa::Program& program) {
  ProgramListing out;
  out.shader = program.name;
  out.stage = isa::name_of(program.stage);
  out.files = program.files;
  for (size_t i = 0; i < program.code.size(); ++i) {
    const isa::Line& line = program.lines[i];
    out.isa.push_back({isa::to_text(program, program.code[i]), line.file, line.line, line.spirv, line.scope});
  }
  for (const isa::SpirvLine& each : program.spirv)
    out.spirv.push_back({each.text, each.line.file, each.line.line, each.line.spirv, each.line.scope});
  for (const isa::Scope& scope : program.scopes)
    out.scopes.push_back({scope.function, scope.caller, scope.call.file, scope.call.line});
  return out;
}

}  // namespace

double growth(const std::vector<const UnitSamples*>& units, size_t sample, size_t column) {
  uint64_t sum = 0;
  for (const UnitSamples* unit : units)
    sum += (*unit)[sample][column] - (sample ? (*unit)[sample - 1][column] : 0);
  return double(sum);
}

void observe(TimingMachine& machine, const Observation& what) {
  for (uint32_t i = 0; i < machine.num_cores(); ++i) {
    core::CoreCell& core = machine.core(i);
    if (what.profile) core.start_profile();
    if (what.interval() == 0) continue;
    const rt::RtUnit& rt = machine.rt_unit(i);
    const mem::L1Stats& l1 = machine.memory().l1(i).stats();
    core.sampler().start(what.interval(), [&core, &rt, &l1](Cycle at) -> std::vector<uint64_t> {
      return {core.stats().instructions.value(), rt.warp_cycles_until(at), l1.reads.total(), l1.hits.total()};
    });
  }
  if (what.interval() == 0) return;
  for (uint32_t i = 0; i < machine.memory().num_partitions(); ++i) {
    mem::Partition& partition = machine.memory().partition(i);
    partition.sampler().start(what.interval(), [&partition](Cycle at) -> std::vector<uint64_t> {
      const mem::DramModel& dram = partition.dram();
      const uint64_t reads =
          partition.sum([](const mem::L2Slice& slice) { return slice.stats().reads.total(); });
      const uint64_t hits =
          partition.sum([](const mem::L2Slice& slice) { return slice.stats().hits.total(); });
      return {reads, hits, dram.stats().busy_clocks.value(), dram.clocks().clock_at(at)};
    });
  }
}

ProfileTable profile_of(const TimingMachine& machine, const exec::Image& image) {
  ProfileTable table;
  for (size_t i = 0; i < size_t(core::Stall::Count); ++i) table.reasons.emplace_back(name_of(core::Stall(i)));
  if (!machine.core(0).profile()) return table;
  const size_t reasons = table.reasons.size();
  for (uint32_t pc = 0; pc < image.code.size(); ++pc) {
    ProfileRow row = row_of(image, pc, reasons);
    for (uint32_t i = 0; i < machine.num_cores(); ++i) add(row, machine.core(i).profile()->of(pc));
    if (row.issues > 0 || row.total() > 0) table.rows.push_back(std::move(row));
  }
  ProfileRow nowhere;
  nowhere.slots.resize(reasons);
  for (uint32_t i = 0; i < machine.num_cores(); ++i) add(nowhere, machine.core(i).profile()->nowhere());
  table.rows.push_back(std::move(nowhere));
  for (const isa::Program& program : image.programs) table.programs.push_back(listing_of(program));
  return table;
}

SeriesTable series_of(TimingMachine& machine, Cycle interval) {
  SeriesTable table;
  table.columns = {"cycle",    "ipc",          "rt_warps",  "l1d_miss_rate", "l2_miss_rate",
                   "dram_use", "instructions", "l1d_reads", "l2_reads"};
  std::vector<const UnitSamples*> cores, partitions;
  for (uint32_t i = 0; i < machine.num_cores(); ++i) cores.push_back(&machine.core(i).sampler().samples());
  for (uint32_t i = 0; i < machine.memory().num_partitions(); ++i)
    partitions.push_back(&machine.memory().partition(i).sampler().samples());
  for (size_t s = 0; s < cores[0]->size(); ++s) {
    const Cycle begin = s * interval, end = std::min<Cycle>(begin + interval, machine.attributed_cycles());
    const auto of_cores = [&](OfCore column) { return growth(cores, s, column); };
    const auto of_partitions = [&](OfPartition column) { return growth(partitions, s, column); };
    const double cycles = double(end - begin);
    table.rows.push_back({double(end), of_cores(kInstructions) / cycles, of_cores(kRtWarps) / cycles,
                          ratio(of_cores(kL1Reads) - of_cores(kL1Hits), of_cores(kL1Reads)),
                          ratio(of_partitions(kL2Reads) - of_partitions(kL2Hits), of_partitions(kL2Reads)),
                          ratio(of_partitions(kDramBusy), of_partitions(kDramClocks)),
                          of_cores(kInstructions), of_cores(kL1Reads), of_partitions(kL2Reads)});
  }
  return table;
}

}  // namespace glint::pipeline
