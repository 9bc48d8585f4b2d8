// Reads PFM files: floats of one or three channels without compression.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

#include "pictures/decode.h"

namespace glint::pictures {

bool is_pfm(std::string_view file);

// Decodes "PF" (three channels) or "Pf" (one, which becomes all three colours), a line "WIDTH HEIGHT", a line
// "SCALE", and floats with the bottom row first. A negative SCALE says little-endian; its magnitude is
// ignored. Alpha is 1.
DecodedPicture decode_pfm(std::string_view file);

}  // namespace glint::pictures
