// `glint run KERNEL`: launches a PTX kernel on the simulated GPU.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "apps/glint/run/launch_options.h"
#include "apps/glint/session.h"

namespace glint::app {

// Whether `glint run` means a kernel, not a scene: a path that ends in .ptx or .toml.
bool names_kernel(const std::string& what);

// `what` is a PTX file, and `launch_file` its launch file, or `what` is the launch file that names the PTX
// file.
Exit run_ptx(const Session& session, const std::string& what, const std::string& launch_file,
             const LaunchOptions& options);

}  // namespace glint::app
