// Decodes the blocks of BC1 to BC7, after the Khronos Data Format specification 1.4.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "exec/texture_format.h"

namespace glint::exec {

// Returns the words of a texel, from 0 to 15 in rows of four, of a block. Choice: what BC1 to BC5 interpolate
// is rounded once, to a float, where hardware may keep fewer bits; formats with sRGB convert the interpolated
// values.
Words decode_block(TexelFormat format, const std::byte* block, uint32_t texel);

// These are exact. BC6H has the bits of halves for red, green and blue.
std::array<uint16_t, 3> decode_bc6h(const std::byte* block, uint32_t texel, bool is_signed);
std::array<uint8_t, 4> decode_bc7(const std::byte* block, uint32_t texel);

}  // namespace glint::exec
