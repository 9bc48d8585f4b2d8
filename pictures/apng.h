// Puts pictures of one size behind each other into one animated PNG.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace glint::pictures {

// Holds how long each picture is shown: a fraction of a second.
struct FrameTime {
  uint16_t numerator = 1, denominator = 24;
};

// Returns the bytes of an animated PNG (PNG specification, third edition, 11.3.6) that shows `pngs` one after
// another and begins again for ever. Each is the whole file of a PNG as png_bytes() makes it, all of the same
// size and kind, and there is one at least. A reader that knows no animation shows the first one. The same
// pictures give the same bytes.
std::string apng_bytes(std::span<const std::string> pngs, const FrameTime& time);

}  // namespace glint::pictures
