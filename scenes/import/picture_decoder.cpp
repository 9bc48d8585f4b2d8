// Calls stb_image. Its functions stay in this file, because other libraries bring their own copies of it.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/picture_decoder.h"

#include <algorithm>
#include <fmt/format.h>
#include <memory>

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
namespace {

constexpr int kChannels = 4;
// Vulkan's maxImageDimension2D of today's GPUs. A small file can claim a picture of any size.
constexpr int kMostPixels = 32768;  // in a row or a column

// Returns the picture of `file`, which `load(file..., &width, &height, &channels, kChannels)` gives as pixels
// of type T, or why it gives none. `measure` has the same form and reads only the size.
template <class T, class Measure, class Load, class... File>
DecodedPicture decoded(std::vector<T> DecodedPicture::*pixels, Measure measure, Load load, File... file) {
  int width = 0, height = 0, channels = 0;
  DecodedPicture out;
  if (measure(file..., &width, &height, &channels) && std::max(width, height) > kMostPixels) {
    out.error = fmt::format("it has {}x{} pixels, and at most {} in a row or column are read", width, height,
                            kMostPixels);
    return out;
  }
  const std::unique_ptr<T, void (*)(void*)> data(load(file..., &width, &height, &channels, kChannels),
                                                 stbi_image_free);
  if (!data) {
    out.error = stbi_failure_reason() ? stbi_failure_reason() : "unknown kind";
    return out;
  }
  out.width = uint32_t(width), out.height = uint32_t(height);
  (out.*pixels).assign(data.get(), data.get() + kChannels * size_t(width) * size_t(height));
  return out;
}

}  // namespace

bool is_hdr_picture(const std::string& path) {
  return stbi_is_hdr(path.c_str()) != 0;
}

DecodedPicture decode_picture_file(const std::string& path) {
  if (!is_hdr_picture(path)) return decode_picture_bytes_of_file(path);
  return decoded(&DecodedPicture::floats, stbi_info, stbi_loadf, path.c_str());
}

DecodedPicture decode_picture_bytes_of_file(const std::string& path) {
  return decoded(&DecodedPicture::bytes, stbi_info, stbi_load, path.c_str());
}

DecodedPicture decode_picture(std::span<const uint8_t> file) {
  return decoded(&DecodedPicture::bytes, stbi_info_from_memory, stbi_load_from_memory, file.data(),
                 int(file.size()));
}

}  // namespace glint::scenes
