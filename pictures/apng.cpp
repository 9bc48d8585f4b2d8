// Writes animated PNGs from the chunks of PNGs.
// SPDX-License-Identifier: Apache-2.0
#include "pictures/apng.h"

#include <cstddef>
#include <string_view>
#include <zlib.h>

#include "base/check.h"

namespace glint::pictures {
namespace {

constexpr size_t kSignature = 8;  // bytes before the first chunk
constexpr size_t kAround = 12;    // bytes of a chunk besides its data: length, type, check

std::string big_endian(uint32_t value, int bytes = 4) {
  std::string out;
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) out += char(value >> shift & 0xff);
  return out;
}

uint32_t number_at(std::string_view bytes, size_t at) {
  uint32_t out = 0;
  for (size_t i = 0; i < 4; ++i) out = out << 8 | uint8_t(bytes[at + i]);
  return out;
}

std::string chunk(std::string_view type, std::string_view data) {
  const std::string body = std::string(type) + std::string(data);
  const uLong check = crc32(0, reinterpret_cast<const Bytef*>(body.data()), uInt(body.size()));
  return big_endian(uint32_t(data.size())) + body + big_endian(uint32_t(check));
}

// Calls take(type, data) for each chunk of a PNG.
template <class Take>
void for_chunks(std::string_view png, const Take& take) {
  for (size_t at = kSignature; at + kAround <= png.size();) {
    const size_t length = number_at(png, at);
    GLINT_CHECK(length <= png.size() - at - kAround, "a chunk of {} bytes leaves its PNG", length);
    take(png.substr(at + 4, 4), png.substr(at + 8, length));
    at += kAround + length;
  }
}

}  // namespace

std::string apng_bytes(std::span<const std::string> pngs, const FrameTime& time) {
  GLINT_CHECK(!pngs.empty(), "an animation without pictures");
  std::string out = pngs[0].substr(0, kSignature), header;
  uint32_t sequence = 0;  // of the chunks fcTL and fdAT
  for (size_t i = 0; i < pngs.size(); ++i) {
    for_chunks(pngs[i], [&](std::string_view type, std::string_view data) {
      if (type == "IHDR" && i == 0) {
        header = data;
        out += chunk(type, data);
        out += chunk("acTL", big_endian(uint32_t(pngs.size())) + big_endian(0));  // 0: for ever
      } else if (type == "IHDR") {
        GLINT_CHECK(data == header, "picture {} of an animation has another size or kind", i);
      }
      if (type == "IHDR") {  // width, height, x, y, time, and how to dispose and blend: nothing, replace
        out += chunk("fcTL", big_endian(sequence++) + std::string(data.substr(0, 8)) + big_endian(0) +
                                 big_endian(0) + big_endian(time.numerator, 2) +
                                 big_endian(time.denominator, 2) + std::string(2, '\0'));
      } else if (type == "IDAT") {
        out += i == 0 ? chunk(type, data) : chunk("fdAT", big_endian(sequence++) + std::string(data));
      }
    });
  }
  return out + chunk("IEND", "");
}

}  // namespace glint::pictures
