// Finds out what kind of picture a file is. stb_image's functions stay in this file, because other libraries
// bring their own copies of them.
// SPDX-License-Identifier: Apache-2.0
#include "pictures/decode.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <memory>
#include <optional>

#include "base/regular_file.h"
#include "pictures/exr.h"
#include "pictures/pfm.h"

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
#define STBI_NO_STDIO
#include <stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace glint::pictures {
namespace {

constexpr int kChannels = 4;

DecodedPicture unreadable() {
  DecodedPicture out;
  out.error = "the file cannot be read";
  return out;
}

const stbi_uc* data_of(std::string_view file) {
  return reinterpret_cast<const stbi_uc*>(file.data());
}

// Returns the picture of `file`, which `load` gives as pixels of type T, or why it gives none.
template <class T, class Load>
DecodedPicture decoded(std::vector<T> DecodedPicture::*pixels, Load load, std::string_view file) {
  int width = 0, height = 0, channels = 0;
  DecodedPicture out;
  if (file.size() > size_t(std::numeric_limits<int>::max())) {
    out.error = "the file is larger than 2 GiB";
    return out;
  }
  const int size = int(file.size());
  if (stbi_info_from_memory(data_of(file), size, &width, &height, &channels) &&
      std::max(width, height) > kMostPixels) {
    out.error = fmt::format("it has {}x{} pixels, and at most {} in a row or column are read", width, height,
                            kMostPixels);
    return out;
  }
  const std::unique_ptr<T, void (*)(void*)> data(
      load(data_of(file), size, &width, &height, &channels, kChannels), stbi_image_free);
  if (!data) {
    out.error = stbi_failure_reason() ? stbi_failure_reason() : "unknown kind";
    return out;
  }
  out.width = uint32_t(width), out.height = uint32_t(height);
  (out.*pixels).assign(data.get(), data.get() + kChannels * size_t(width) * size_t(height));
  return out;
}

bool is_hdr(std::string_view file) {
  return stbi_is_hdr_from_memory(data_of(file),
                                 int(std::min<size_t>(file.size(), std::numeric_limits<int>::max()))) != 0;
}

// Replaces floats by bytes.
DecodedPicture with_bytes(DecodedPicture picture) {
  picture.bytes.reserve(picture.floats.size());
  for (size_t i = 0; i < picture.floats.size(); ++i) {
    const float value = picture.floats[i], shown = i % kChannels == 3 ? value : std::pow(value, 1 / 2.2f);
    // This is 0 for what is not a number, too, and so for negative values.
    picture.bytes.push_back(shown > 0 ? uint8_t(std::min(shown, 1.0f) * 255 + 0.5f) : uint8_t{0});
  }
  picture.floats.clear();
  return picture;
}

DecodedPicture to_bytes(std::string_view file) {
  if (is_exr(file)) return with_bytes(decode_exr(file));
  if (is_pfm(file)) return with_bytes(decode_pfm(file));
  return decoded(&DecodedPicture::bytes, stbi_load_from_memory, file);
}

}  // namespace

DecodedPicture decode_picture_file(const std::string& path) {
  const std::optional<std::string> file = read_regular_file(path);
  if (!file) return unreadable();
  if (is_exr(*file)) return decode_exr(*file);
  if (is_pfm(*file)) return decode_pfm(*file);
  if (is_hdr(*file)) return decoded(&DecodedPicture::floats, stbi_loadf_from_memory, *file);
  return decoded(&DecodedPicture::bytes, stbi_load_from_memory, *file);
}

DecodedPicture decode_picture_bytes_of_file(const std::string& path) {
  const std::optional<std::string> file = read_regular_file(path);
  return file ? to_bytes(*file) : unreadable();
}

DecodedPicture decode_picture(std::span<const uint8_t> file) {
  return to_bytes({reinterpret_cast<const char*>(file.data()), file.size()});
}

}  // namespace glint::pictures
