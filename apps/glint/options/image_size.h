// The --size of a picture.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "scenes/camera.h"

namespace glint::app {

// "128x64" into width and height. UserError when it is no size, or too large.
void parse_size(const std::string& text, scenes::RenderParams& frame);

}  // namespace glint::app
