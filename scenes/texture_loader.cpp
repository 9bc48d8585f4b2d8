// Picture files as textures of a scene.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/texture_loader.h"

#include <filesystem>
#include <memory>

#include "base/diagnostics.h"

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#endif
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#include <stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace glint::scenes {

Texture load_texture(const std::string& path) {
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, void (*)(void*)> texels(stbi_load(path.c_str(), &width, &height, &channels, 4),
                                                         stbi_image_free);
  if (!texels)
    throw UserError({path}, std::string("this texture cannot be read: ") + stbi_failure_reason(),
                    "expected a PNG or JPEG file");
  Texture texture{std::filesystem::path(path).stem().string(), uint32_t(width), uint32_t(height), {}};
  texture.rgba.assign(texels.get(), texels.get() + 4 * size_t(width) * size_t(height));
  return texture;
}

}  // namespace glint::scenes
