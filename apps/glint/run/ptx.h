// Declares `glint run KERNEL`, which launches a PTX kernel on the simulated GPU.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "apps/glint/run/launch_options.h"
#include "apps/glint/session.h"

namespace glint::app {

// Returns whether `glint run` means a kernel and not a scene: a path that ends in .ptx or .toml.
bool names_kernel(const std::string& what);

// Launches a kernel. `what` is a PTX file and `launch_file` is its launch file, or `what` is a launch file
// that names the PTX file.
Exit run_ptx(const Session& session, const std::string& what, const std::string& launch_file,
             const LaunchOptions& options);

}  // namespace glint::app
