// The options of a frame that `run` and `bench` share.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "scenes/camera.h"

namespace CLI {
class App;
}

namespace glint::app {

void add_frame_options(CLI::App& command, scenes::RenderParams& frame);

}  // namespace glint::app
