// Holds the options that every kind of launch takes: scenes, pipelines, kernels and scripts.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/glint/options/command_line.h"
#include "apps/glint/options/sample_options.h"
#include "apps/glint/options/shader_options.h"
#include "exec/fault.h"
#include "pipeline/params.h"
#include "pipeline/run_profile.h"
#include "setup/resources.h"

namespace glint::app {

struct LaunchOptions {
  std::string config = "mobile";                  // preset or TOML file
  std::string mode = "timing";                    // "timing" or "functional"
  bool config_given = false, mode_given = false;  // set when the command line named them
  std::string out;                                // run directory; empty: the kind of launch chooses one
  std::vector<std::string> settings;              // KEY=VALUE; the oracles come first
  std::vector<std::string> oracles;               // as --oracle names them
  uint64_t max_instructions = 0;                  // limit of a warp; 0: the limit of the configuration
  uint64_t max_cycles = 0;                        // limit of the launch; 0: none
  std::string stats = "full";                     // "full" or "compact"
  bool compact() const { return stats == "compact"; }
  bool json = false;                             // print statistics as JSON instead of the summary
  bool no_skip = false;                          // step every cycle
  uint32_t threads = 0;                          // threads of the host; 0: all processors
  std::string on_fault_name = "stop";            // "stop" or "warn"
  exec::OnFault on_fault = exec::OnFault::Stop;  // the value of on_fault_name
  uint64_t print_limit = 1000;                   // messages of debugPrintfEXT to show
  ShaderOptions shaders;
  pipeline::Observation observe;
  SampleChoice sample;
};

// Adds the options to the command. They are complete once finish_launch_options() has been called after
// parsing.
void add_launch_options(Command command, LaunchOptions& options);
void finish_launch_options(const Command& command, LaunchOptions& options);

void add_stats_option(Command command, std::string& stats);  // adds --stats
void add_max_cycles_option(Command command, uint64_t& max_cycles,
                           const std::string& help);  // adds --max-cycles

// Throws UserError when a sampled run was asked for together with something that needs a whole launch.
void check_sample(const LaunchOptions& options);

// Throws UserError when the functional machine is given a limit of cycles.
void check_max_cycles(uint64_t max_cycles, bool timing);

// Returns the configuration with its overrides, of which max_instructions is one.
pipeline::GpuParams gpu_of(const setup::Resources& resources, const LaunchOptions& options);

}  // namespace glint::app
