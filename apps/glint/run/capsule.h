// Runs a capsule: one launch of an application, saved by the Vulkan driver with all that it can reach.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "apps/glint/run/launch_options.h"
#include "apps/glint/session.h"

namespace glint::app {

// Returns whether `what` is the name of a capsule's file.
bool names_capsule(const std::string& what);
// Runs the launch, and writes the images that it changed as pictures.
Exit run_capsule(const Session& session, const std::string& what, const LaunchOptions& options);

}  // namespace glint::app
