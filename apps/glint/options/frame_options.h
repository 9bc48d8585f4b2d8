// Adds the options of a frame, which `run` and `bench` share.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "apps/glint/options/command_line.h"
#include "scenes/camera.h"

namespace glint::app {

// Adds --crop, whose text parse_crop() reads.
void add_crop_option(Command command, std::string& crop);

void add_frame_options(Command command, scenes::RenderParams& frame);

}  // namespace glint::app
