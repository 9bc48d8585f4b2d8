// Reads the configuration of a run, and has the options --oracle, --jobs and --assets.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/config.h"

#include <cstdio>
#include <fmt/format.h>

#include "setup/oracles.h"

namespace glint::app {

pipeline::GpuParams read_config(const setup::Resources& resources, const std::string& name_or_path,
                                const std::vector<std::string>& settings) {
  const pipeline::GpuParams params = setup::read_preset(resources, name_or_path, settings);
  for (const std::string& oddity : setup::oddities_of(params)) fmt::print(stderr, "{}\n", oddity);
  return params;
}

void add_oracle_option(Command command, std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const auto& [name, doc] : setup::oracle_list()) known.push_back(name);
  command
      .add_option("--oracle", names,
                  "Give the machine what no hardware can have, to bound what an idea can gain; 'glint list "
                  "oracles' has the names; repeatable")
      .type_name("NAME")
      .one_of(known)
      .allow_extra_args(false);
}

void add_jobs_option(Command command, uint32_t& processes) {
  command
      .add_option("-j,--jobs", processes, "Number of processes that run at a time; 0: one for each processor")
      .in_range(0u, 1024u)
      .capture_default_str();
}

void add_assets_option(Command command, std::string& folder, const std::string& addition) {
  command.add_option("--assets", folder, "Folder that has the original scene data" + addition)
      .type_name("DIR")
      .envname("GLINT_ASSETS");
}

}  // namespace glint::app
