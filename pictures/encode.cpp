// Encodes images.
// SPDX-License-Identifier: Apache-2.0
#include "pictures/encode.h"

#include <bit>
#include <fmt/format.h>
#include <vector>

#include "base/check.h"

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#endif
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace glint::pictures {
namespace {

uint8_t to_byte(float value) {
  if (!(value > 0.0f)) return 0;  // This also catches values that are not a number.
  return value >= 1.0f ? uint8_t{255} : uint8_t(value * 255.0f + 0.5f);
}

void check_size(const ImageView& image) {
  GLINT_CHECK_EQ(image.rgba.size(), size_t{image.width} * image.height * 4);
}

}  // namespace

std::string png_bytes(const ImageView& image) {
  check_size(image);
  std::vector<uint8_t> rgb;
  rgb.reserve(size_t{image.width} * image.height * 3);
  for (size_t i = 0; i < image.rgba.size(); i += 4)
    for (size_t c = 0; c < 3; ++c) rgb.push_back(to_byte(image.rgba[i + c]));
  std::string out;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data), size_t(size));
  };
  const int done = stbi_write_png_to_func(append, &out, int(image.width), int(image.height), 3, rgb.data(),
                                          int(image.width) * 3);
  GLINT_CHECK(done != 0, "the PNG encoder refused a {}x{} image", image.width, image.height);
  return out;
}

std::string pfm_bytes(const ImageView& image) {
  check_size(image);
  // A negative scale says little endian.
  std::string out = fmt::format("PF\n{} {}\n-1.0\n", image.width, image.height);
  for (uint32_t row = image.height; row-- > 0;)
    for (uint32_t x = 0; x < image.width; ++x)
      for (size_t c = 0; c < 3; ++c) {
        const auto bits = std::bit_cast<uint32_t>(image.rgba[(size_t{row} * image.width + x) * 4 + c]);
        for (int shift = 0; shift < 32; shift += 8) out += char(bits >> shift & 0xff);
      }
  return out;
}

}  // namespace glint::pictures
