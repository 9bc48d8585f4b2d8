// Reads picture files as textures of a scene.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/texture_loader.h"

#include <filesystem>
#include <utility>

#include "base/diagnostics.h"
#include "scenes/import/picture_decoder.h"

namespace glint::scenes {
namespace {

Texture texture_of(const std::string& name, const std::string& place, DecodedPicture picture) {
  if (!picture.error.empty())
    throw UserError({place}, "this texture cannot be read: " + picture.error, "expected a PNG or JPEG file");
  return {name, picture.width, picture.height, std::move(picture.bytes)};
}

}  // namespace

Texture load_texture(const std::string& path) {
  return texture_of(std::filesystem::path(path).stem().string(), path, decode_picture_bytes_of_file(path));
}

Texture decode_texture(const std::string& name, std::span<const uint8_t> bytes) {
  return texture_of(name, name, decode_picture(bytes));
}

}  // namespace glint::scenes
