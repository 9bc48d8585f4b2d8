// Makes the machine that --config, --set and --oracle ask for.
// SPDX-License-Identifier: Apache-2.0
#pragma once
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

}  // namespace glint::app
