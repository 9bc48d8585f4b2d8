// Reads picture files as textures of a scene.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "scenes/scene.h"

namespace glint::scenes {

// Reads a PNG, JPEG, HDR, PFM or EXR file as RGBA8; alpha is 255 where the file has none. Throws UserError
// when the file cannot be read.
Texture load_texture(const std::string& path);

}  // namespace glint::scenes
