// Reads picture files as textures of a scene.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace glint::scenes {

// Reads a PNG, JPEG, HDR, PFM or EXR file as RGBA8; alpha is 255 where the file has none. Throws UserError
// when the file cannot be read.
Texture load_texture(const std::string& path);

// Reads several files in the same way, on up to `threads` threads of the host. Of several files that cannot
// be read, the first is named.
std::vector<Texture> load_textures(const std::vector<std::string>& paths, uint32_t threads);

}  // namespace glint::scenes
