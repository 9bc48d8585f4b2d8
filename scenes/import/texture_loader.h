// Picture files as textures of a scene.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "scenes/scene.h"

namespace glint::scenes {

// Reads a PNG or JPEG file as RGBA8, alpha 255 where the file has none. UserError when it cannot be read.
Texture load_texture(const std::string& path);

// The same of a file's bytes; `name` is the texture's, and the place that errors name.
Texture decode_texture(const std::string& name, std::span<const uint8_t> bytes);

}  // namespace glint::scenes
