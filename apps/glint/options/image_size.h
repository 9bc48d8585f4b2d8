// Reads the --size of a picture.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "scenes/camera.h"

namespace glint::app {

// Reads "128x64" into width and height. Throws UserError when the text is not a size, or the size is too
// large.
void parse_size(const std::string& text, scenes::RenderParams& frame);

}  // namespace glint::app
