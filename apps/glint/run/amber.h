// `glint run SCRIPT.amber ...`: runs Amber scripts and says which pass.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "apps/glint/options/shader_options.h"
#include "apps/glint/session.h"
#include "exec/fault.h"

namespace glint::app {

struct AmberOptions {
  std::vector<std::string> scripts;
  std::string config = "mobile";
  std::vector<std::string> settings;
  uint64_t max_instructions = 0;
  bool timing = false, no_skip = false;
  uint32_t threads = 0;  // of the host
  exec::OnFault on_fault = exec::OnFault::Stop;
  ShaderOptions shaders;     // their folders and macros mean nothing to a script
  uint64_t print_limit = 0;  // of each launch
};

bool names_script(const std::string& what);  // a path that ends in .amber

// 0: all passed. Of one script that fails: 1 for an expectation, 2 to 5 for an error of that kind. Of
// several: 1 when any fails, else 3 when any is unsupported.
Exit run_amber(const Session& session, const AmberOptions& options);

}  // namespace glint::app
