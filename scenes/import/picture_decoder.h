// Pixels of PNG, JPEG, HDR and other picture files: the only place that knows the library which reads them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint::scenes {

// Rows from the top, four channels a pixel, in `bytes` or, of HDR files that were read as such, in `floats`.
struct DecodedPicture {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> bytes;
  std::vector<float> floats;
  std::string error;  // why there are no pixels; empty when there are
};

bool is_hdr_picture(const std::string& path);
// An HDR file gives floats; all others give bytes.
DecodedPicture decode_picture_file(const std::string& path);
// Bytes, whatever the file.
DecodedPicture decode_picture_bytes_of_file(const std::string& path);
DecodedPicture decode_picture(std::span<const uint8_t> file);

}  // namespace glint::scenes
