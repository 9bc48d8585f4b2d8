// `glint run FILE.toml` and `glint run SHADER`: a launch of a described pipeline on the simulated GPU.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "apps/glint/options/shader_options.h"
#include "apps/glint/session.h"
#include "exec/fault.h"
#include "pipeline/run_profile.h"

namespace glint::app {

// What the command line says; empty where it says nothing and the file decides.
struct PipelineOptions {
  std::string what, config, mode, out;
  std::vector<std::string> settings;
  uint64_t max_instructions = 0;
  bool json = false, no_skip = false;
  uint32_t threads = 0;  // of the host
  ShaderOptions shaders;
  uint64_t print_limit = 0;
  exec::OnFault on_fault = exec::OnFault::Stop;
  pipeline::Observation observe;
};

// A shader file, or a TOML file that is no launch of a kernel.
bool names_pipeline(const std::string& what);
Exit run_pipeline(const Session& session, const PipelineOptions& options);

}  // namespace glint::app
