// Decodes PNG, JPEG, HDR and other picture files. Only this place knows the library that reads them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint::scenes {

// Holds a picture: rows from the top, with four channels per pixel. The pixels are in `floats` for HDR files
// that were read as such, and in `bytes` otherwise.
struct DecodedPicture {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> bytes;
  std::vector<float> floats;
  std::string error;  // why there are no pixels; empty when there are
};

bool is_hdr_picture(const std::string& path);
// Decodes a file. An HDR file gives floats; all others give bytes.
DecodedPicture decode_picture_file(const std::string& path);
// Decodes a file of any kind to bytes.
DecodedPicture decode_picture_bytes_of_file(const std::string& path);
DecodedPicture decode_picture(std::span<const uint8_t> file);

}  // namespace glint::scenes
