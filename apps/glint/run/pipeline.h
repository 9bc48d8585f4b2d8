// `glint run FILE.toml` and `glint run SHADER`: a launch of a described pipeline on the simulated GPU.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "apps/glint/run/launch_options.h"
#include "apps/glint/session.h"

namespace glint::app {

// A shader file, or a TOML file that is no launch of a kernel.
bool names_pipeline(const std::string& what);
// What the command line names wins over what the file says.
Exit run_pipeline(const Session& session, const std::string& what, const LaunchOptions& options);

}  // namespace glint::app
