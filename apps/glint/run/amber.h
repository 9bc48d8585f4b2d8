// `glint run SCRIPT.amber ...`: runs Amber scripts and says which pass.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "apps/glint/run/launch_options.h"
#include "apps/glint/session.h"

namespace glint::app {

bool names_script(const std::string& what);  // a path that ends in .amber

// 0: all passed. Of one script that fails: 1 for an expectation, 2 to 5 for an error of that kind. Of
// several: 1 when any fails, else 3 when any is unsupported.
// Scripts run on the timing machine where the command line names the mode timing, else on the functional one.
Exit run_amber(const Session& session, const std::vector<std::string>& scripts, const LaunchOptions& options);

}  // namespace glint::app
