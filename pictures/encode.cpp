// Encodes images.
// SPDX-License-Identifier: Apache-2.0
#include "pictures/encode.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <vector>

#include "base/check.h"
#include "base/parallel_ranges.h"
#include "pictures/deflate.h"

namespace glint::pictures {
namespace {

thread_local uint32_t deflating_threads = 1;  // stb_image_write has no argument that reaches deflate()

// Compresses in place of stb_image_write, which asks for memory of malloc().
unsigned char* deflate(const unsigned char* bytes, int size, int* compressed_size) {
  const std::string stream = zlib_stream({bytes, size_t(size)}, deflating_threads);
  auto* out = static_cast<unsigned char*>(std::malloc(stream.size()));
  if (out) std::copy(stream.begin(), stream.end(), out);
  *compressed_size = int(stream.size());
  return out;
}

}  // namespace
}  // namespace glint::pictures

#define STBIW_ZLIB_COMPRESS(bytes, size, compressed_size, quality) \
  glint::pictures::deflate(bytes, size, compressed_size)
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

static_assert(std::endian::native == std::endian::little, "PFM files are written little-endian");
constexpr size_t kPixelsOfRange = 1 << 16;  // pixels that a thread converts at a time

uint8_t to_byte(float value) {
  if (!(value > 0.0f)) return 0;  // This also catches values that are not a number.
  return value >= 1.0f ? uint8_t{255} : uint8_t(value * 255.0f + 0.5f);
}

void check_size(const ImageView& image) {
  GLINT_CHECK_EQ(image.rgba.size(), size_t{image.width} * image.height * 4);
}

}  // namespace

std::string png_bytes(const ImageView& image, uint32_t threads) {
  check_size(image);
  const size_t row = size_t{image.width} * 3;
  std::vector<uint8_t> rgb(row * image.height);
  parallel_ranges(rgb.size() / 3, kPixelsOfRange, threads, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      for (size_t c = 0; c < 3; ++c) rgb[i * 3 + c] = to_byte(image.rgba[i * 4 + c]);
  });
  std::string out;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data), size_t(size));
  };
  deflating_threads = threads;
  const int done =
      stbi_write_png_to_func(append, &out, int(image.width), int(image.height), 3, rgb.data(), int(row));
  GLINT_CHECK(done != 0, "the PNG encoder refused a {}x{} image", image.width, image.height);
  return out;
}

std::string pfm_bytes(const ImageView& image, uint32_t threads) {
  check_size(image);
  // A negative scale says little endian.
  std::string out = fmt::format("PF\n{} {}\n-1.0\n", image.width, image.height);
  const size_t header = out.size(), row = size_t{image.width} * 3 * sizeof(float);
  out.resize(header + row * image.height);
  parallel_ranges(image.height, 1 + kPixelsOfRange / std::max(image.width, 1u), threads,
                  [&](size_t begin, size_t end) {
                    for (size_t y = begin; y < end; ++y) {
                      char* at = out.data() + header + row * (image.height - 1 - y);
                      for (size_t i = 0; i < image.width; ++i, at += 3 * sizeof(float))
                        std::memcpy(at, &image.rgba[(y * image.width + i) * 4], 3 * sizeof(float));
                    }
                  });
  return out;
}

}  // namespace glint::pictures
