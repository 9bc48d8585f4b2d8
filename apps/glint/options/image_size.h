// Reads the --size and the --crop of a picture.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "scenes/camera.h"

namespace glint::app {

// Reads "128x64" into width and height. Throws UserError when the text is not a size, or the size is too
// large.
void parse_size(const std::string& text, scenes::RenderParams& frame);

// Makes the picture the window "X,Y,WIDTH,HEIGHT" of the frame, which has its size already. Without text the
// picture stays the whole frame. Throws UserError when the text is not a window that lies in the frame.
void parse_crop(const std::string& text, scenes::RenderParams& frame);

}  // namespace glint::app
