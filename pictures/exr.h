// Reads and writes EXR files: floats of named channels, compressed without loss.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "pictures/decode.h"
#include "pictures/encode.h"

namespace glint::pictures {

bool is_exr(std::string_view file);

// Decodes the data window of a file of one part, by lines or by tiles of one level,
// without compression or with RLE, ZIPS, ZIP or PIZ. The channels R, G, B and A are read; colours that are
// absent are 0, and alpha is 1. A file with Y and no colours, or with one channel only, is grey.
DecodedPicture decode_exr(std::string_view file);

// Returns 32-bit floats of the channels A, B, G and R, compressed by ZIP. Values are not clamped.
std::string exr_bytes(const ImageView& image);

}  // namespace glint::pictures
