// Renders the frames of a scene that moves, each with a run directory of its own.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "apps/glint/run/launch_options.h"
#include "apps/glint/run/scene.h"
#include "apps/glint/session.h"

namespace glint::app {

// Renders SequenceOptions::frames one after another on one device. The run directory has the sum of their
// statistics, a picture of each, an animated picture, and frames.csv; each frame has a run directory in it.
Exit run_frames(const Session& session, const SceneOptions& options, const LaunchOptions& launch);

}  // namespace glint::app
