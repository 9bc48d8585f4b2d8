// Reads the pictures that runs leave.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <sstream>

#include "base/diagnostics.h"
#include "report/picture/image_compare.h"

// stb's functions stay in this file, because other libraries bring their own copies of it.
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include <stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace glint::report {
namespace {

constexpr uint32_t kMaxSide = 1u << 16;  // pixels; a file with more is damaged

// Reads "PF
// WIDTH HEIGHT
// SCALE
// " and then floats, with the bottom row first. A negative SCALE says little-endian.
Picture read_pfm(const std::string& bytes, const std::string& path) {
  std::istringstream in(bytes);
  std::string magic;
  int64_t width = 0, height = 0;
  double scale = 0;
  if (!(in >> magic >> width >> height >> scale) || width < 1 || height < 1 || width > kMaxSide ||
      height > kMaxSide || scale == 0)
    throw UserError({path}, "the header is not that of a PFM");
  const size_t begin = size_t(in.tellg()) + 1, row = size_t(width) * 3;
  if (bytes.size() != begin + row * size_t(height) * sizeof(float))
    throw UserError({path}, fmt::format("the file has {} bytes, expected {}", bytes.size(),
                                        begin + row * size_t(height) * sizeof(float)));
  Picture out{uint32_t(width), uint32_t(height), std::vector<float>(row * size_t(height))};
  for (size_t y = 0; y < size_t(height); ++y)
    for (size_t i = 0; i < row; ++i) {
      uint32_t word = 0;
      std::memcpy(&word, bytes.data() + begin + (y * row + i) * sizeof word, sizeof word);
      if ((scale < 0) != (std::endian::native == std::endian::little)) word = __builtin_bswap32(word);
      out.rgb[(size_t(height) - 1 - y) * row + i] = std::bit_cast<float>(word);
    }
  return out;
}

Picture read_png(const std::string& bytes, const std::string& path) {
  int width = 0, height = 0, channels = 0;
  stbi_uc* pixels = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), int(bytes.size()),
                                          &width, &height, &channels, 3);
  if (!pixels)
    throw UserError({path}, fmt::format("cannot read the picture: {}", stbi_failure_reason()),
                    "expected a PFM or a PNG");
  Picture out{uint32_t(width), uint32_t(height), std::vector<float>(size_t(width) * size_t(height) * 3)};
  for (size_t i = 0; i < out.rgb.size(); ++i) out.rgb[i] = float(pixels[i]) / 255.0f;
  stbi_image_free(pixels);
  return out;
}

}  // namespace

Picture read_picture(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw UserError({path}, "cannot read the file");
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  return bytes.rfind("PF", 0) == 0 ? read_pfm(bytes, path) : read_png(bytes, path);
}

}  // namespace glint::report
