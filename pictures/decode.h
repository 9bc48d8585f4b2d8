// Decodes PNG, JPEG, HDR, PFM, EXR and other picture files. Only this folder knows the libraries that do it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::pictures {

// Vulkan's maxImageDimension2D of today's GPUs. A small file can claim a picture of any size.
inline constexpr int64_t kMostPixels = 32768;     // in a row or a column
inline constexpr uint64_t kMostBytes = 1u << 30;  // of one picture, when it is decoded

// Holds a picture: rows from the top, with four channels per pixel. The pixels are in `floats` for files that
// hold floats and were read as such, and in `bytes` otherwise.
struct DecodedPicture {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> bytes;
  std::vector<float> floats;
  std::string error;  // why there are no pixels; empty when there are
};

// Decodes a file. Files that hold floats give floats; all others give bytes.
DecodedPicture decode_picture_file(const std::string& path);

// Decodes a file of any kind to bytes. Floats v become 255 * v^(1/2.2), as stb_image does it for HDR.
DecodedPicture decode_picture_bytes_of_file(const std::string& path);

// Does the same with the bytes of a file.
DecodedPicture decode_picture(std::span<const uint8_t> file);

}  // namespace glint::pictures
