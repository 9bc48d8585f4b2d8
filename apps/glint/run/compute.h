// Declares `glint run PROGRAM`, which runs a program of the compute suite.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "apps/glint/run/launch_options.h"
#include "apps/glint/session.h"

namespace glint::app {

// Returns whether `what` is a program of the compute suite.
bool names_program(const std::string& what);
// Throws UserError for options that a program does not take.
void check_program(const std::string& name, const LaunchOptions& options);
// Runs a program, whose options were checked, on its small or its full input, and checks every value that it
// computes.
Exit run_program(const Session& session, const std::string& what, bool small, const LaunchOptions& options);

}  // namespace glint::app
