// Reads PFM files.
// SPDX-License-Identifier: Apache-2.0
#include "pictures/pfm.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <sstream>
#include <string>

namespace glint::pictures {
namespace {

constexpr int64_t kLongestSide = 1 << 16;  // pixels; frames of runs may have as many
constexpr size_t kLongestHeader = 256;     // bytes

float float_at(const char* at, bool is_swapped) {
  uint32_t word = 0;
  std::memcpy(&word, at, sizeof word);
  return std::bit_cast<float>(is_swapped ? __builtin_bswap32(word) : word);
}

}  // namespace

bool is_pfm(std::string_view file) {
  return file.size() > 2 && file[0] == 'P' && (file[1] == 'F' || file[1] == 'f') &&
         (file[2] == '\n' || file[2] == '\r' || file[2] == ' ');
}

DecodedPicture decode_pfm(std::string_view file) {
  std::istringstream in{std::string(file.substr(0, kLongestHeader))};
  std::string magic;
  int64_t width = 0, height = 0;
  double scale = 0;
  DecodedPicture out;
  if (!(in >> magic >> width >> height >> scale) || in.eof() || width < 1 || height < 1 ||
      width > kLongestSide || height > kLongestSide || scale == 0) {
    out.error = "the header is not that of a PFM";
    return out;
  }
  const size_t channels = magic == "PF" ? 3 : 1, begin = size_t(in.tellg()) + 1;
  const size_t pixel = channels * sizeof(float), row = size_t(width) * pixel;
  if (file.size() != begin + row * size_t(height)) {
    out.error = fmt::format("the file has {} bytes, expected {}", file.size(), begin + row * size_t(height));
    return out;
  }
  const bool is_swapped = (scale < 0) != (std::endian::native == std::endian::little);
  out.width = uint32_t(width), out.height = uint32_t(height);
  out.floats.reserve(size_t(width) * size_t(height) * 4);
  for (size_t y = size_t(height); y-- > 0;)
    for (size_t x = 0; x < size_t(width); ++x) {
      const char* at = file.data() + begin + y * row + x * pixel;
      for (size_t c = 0; c < 3; ++c)
        out.floats.push_back(float_at(at + (channels == 3 ? c : 0) * sizeof(float), is_swapped));
      out.floats.push_back(1);
    }
  return out;
}

}  // namespace glint::pictures
