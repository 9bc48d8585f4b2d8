// Declares `glint run SCRIPT.amber ...`, which runs Amber scripts and says which pass.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "apps/glint/run/launch_options.h"
#include "apps/glint/session.h"

namespace glint::app {

// Holds the options that only scripts have.
struct ScriptOptions {
  // With true, an access outside of a buffer or an image is a fault unless the script declares robust access.
  bool strict = false;
  std::string caches = "cold";  // what a timed launch finds in the L2: "cold" or "warm" (pipeline::Caches)
};

bool names_script(const std::string& what);  // returns whether it is a path that ends in .amber

// Runs the scripts and returns 0 when all pass. For one script, it returns 1 for a failed expectation and 2
// to 5 for an error of that kind. For several scripts, it returns 1 when any fails, else 3 when any is
// unsupported. Scripts run on the timing machine when the command line names the mode timing, and otherwise
// on the functional machine.
// With --out they leave run directories.
Exit run_amber(const Session& session, const std::vector<std::string>& scripts, const LaunchOptions& options,
               const ScriptOptions& script_options);

}  // namespace glint::app
