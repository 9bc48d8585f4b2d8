// Calls stb_image. Its functions stay in this file, because other libraries bring their own copies of it.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/picture_decoder.h"

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

// Returns the picture that `decode(&width, &height, &channels)` gives as pixels of type T, or why it gives
// none.
template <class T, class Decode>
DecodedPicture decoded(std::vector<T> DecodedPicture::*pixels, Decode&& decode) {
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<T, void (*)(void*)> data(decode(&width, &height, &channels), stbi_image_free);
  DecodedPicture out;
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
  return decoded(&DecodedPicture::floats,
                 [&](int* w, int* h, int* n) { return stbi_loadf(path.c_str(), w, h, n, kChannels); });
}

DecodedPicture decode_picture_bytes_of_file(const std::string& path) {
  return decoded(&DecodedPicture::bytes,
                 [&](int* w, int* h, int* n) { return stbi_load(path.c_str(), w, h, n, kChannels); });
}

DecodedPicture decode_picture(std::span<const uint8_t> file) {
  return decoded(&DecodedPicture::bytes, [&](int* w, int* h, int* n) {
    return stbi_load_from_memory(file.data(), int(file.size()), w, h, n, kChannels);
  });
}

}  // namespace glint::scenes
