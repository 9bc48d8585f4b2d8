// Builds a machine with an empty program to ask it for its statistics.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/stat_list.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "exec/image.h"
#include "isa/program.h"
#include "pipeline/params.h"
#include "pipeline/run_stats.h"
#include "pipeline/structure_stats.h"
#include "pipeline/timing_machine.h"
#include "report/terminal/table.h"

namespace glint::app {

std::vector<report::StatName> all_stats() {
  isa::Program program;
  program.name = "empty.rgen";
  program.stage = isa::Stage::RayGeneration;
  program.code.resize(1);
  program.code[0].op = isa::op_index("exit");
  program.lines.resize(1);
  const exec::Image image = exec::link({program});
  mem::AddressSpace memory;
  exec::World world;
  world.image = &image;
  world.memory = &memory;
  world.constant_bank.resize(isa::kConstantBankBytes);
  world.raygen = 0;
  pipeline::GpuParams params;
  params.cores = 1;
  std::vector<report::StatName> out =
      report::stat_names(pipeline::TimingMachine(params, world, false).root());
  const auto add = [&](const stats::Group& root, const char* where) {
    for (report::StatName& row : report::stat_names(root)) {
      if (std::ranges::any_of(out, [&](const report::StatName& have) { return have.path == row.path; }))
        continue;
      row.doc += where;
      out.push_back(std::move(row));
    }
  };
  pipeline::RunStats functional(pipeline::FunctionalCounts{});
  add(functional.root(), " The functional machine counts it.");
  const pipeline::StructureStats frames(&functional.root(), {});
  add(functional.root(), " Runs of frames have it, on either machine.");
  return out;
}

std::string stat_list() {
  std::vector<std::vector<std::string>> cells;
  for (const report::StatName& row : all_stats()) cells.push_back({row.path, row.unit, row.doc});
  return report::table(cells, "");
}

std::string stat_list_markdown() {
  std::string out = "| statistic | unit | meaning |\n|---|---|---|\n";
  for (const report::StatName& row : all_stats())
    out += fmt::format("| `{}` | {} | {} |\n", row.path, row.unit, row.doc);
  return out;
}

}  // namespace glint::app
