// Reads picture files as textures of a scene.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "scenes/scene.h"

namespace glint::scenes {

// Reads a PNG or JPEG file as RGBA8; alpha is 255 where the file has none. Throws UserError when the file
// cannot be read.
Texture load_texture(const std::string& path);

// Does the same with the bytes of a file. `name` becomes the texture's name, and errors name it as their
// place.
Texture decode_texture(const std::string& name, std::span<const uint8_t> bytes);

}  // namespace glint::scenes
