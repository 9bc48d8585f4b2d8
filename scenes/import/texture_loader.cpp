// Reads picture files as textures of a scene.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/texture_loader.h"

#include <filesystem>
#include <utility>

#include "base/diagnostics.h"
#include "base/parallel_ranges.h"
#include "pictures/decode.h"

namespace glint::scenes {

Texture load_texture(const std::string& path) {
  pictures::DecodedPicture picture = pictures::decode_picture_bytes_of_file(path);
  if (!picture.error.empty())
    throw UserError({path}, "this texture cannot be read: " + picture.error,
                    "expected a PNG, JPEG, HDR, PFM or EXR file");
  return {std::filesystem::path(path).stem().string(), picture.width, picture.height,
          std::move(picture.bytes)};
}

std::vector<Texture> load_textures(const std::vector<std::string>& paths, uint32_t threads) {
  std::vector<Texture> textures(paths.size());
  parallel_ranges(paths.size(), 1, threads, [&](size_t i, size_t) { textures[i] = load_texture(paths[i]); });
  return textures;
}

}  // namespace glint::scenes
