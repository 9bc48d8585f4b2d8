// Makes the machine that --config, --set and --oracle ask for, and has options that several commands share.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/glint/options/command_line.h"
#include "setup/config.h"

namespace glint::app {

// Reads a configuration as setup::read_preset() does, and warns on stderr of what is odd about the machine.
pipeline::GpuParams read_config(const setup::Resources& resources, const std::string& name_or_path,
                                const std::vector<std::string>& settings);

// Adds the option --oracle. `names` gets what the user names.
void add_oracle_option(Command command, std::vector<std::string>& names);

// Adds the option --jobs. `processes` gets how many processes run at a time; 0 stands for one a processor.
void add_jobs_option(Command command, uint32_t& processes);

// Adds the option --assets. `addition` follows the sentence of its help.
void add_assets_option(Command command, std::string& folder, const std::string& addition = "");

}  // namespace glint::app
