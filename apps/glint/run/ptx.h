// `glint run KERNEL`: launches a PTX kernel on the simulated GPU.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "apps/glint/session.h"
#include "exec/fault.h"
#include "pipeline/run_profile.h"

namespace glint::app {

struct KernelOptions {
  std::string what;    // the PTX file, or the launch file that names it
  std::string launch;  // the launch file, when `what` is the PTX file
  std::string config = "mobile", mode = "timing", out;
  std::vector<std::string> settings;
  uint64_t max_instructions = 0;
  bool json = false, no_skip = false;
  uint32_t threads = 0;  // of the host
  exec::OnFault on_fault = exec::OnFault::Stop;
  pipeline::Observation observe;
};

// Whether `glint run` means a kernel, not a scene: a path that ends in .ptx or .toml.
bool names_kernel(const std::string& what);

Exit run_ptx(const Session& session, const KernelOptions& options);

}  // namespace glint::app
