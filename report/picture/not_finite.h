// Finds pixels of a picture that are not numbers or infinite.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "pictures/encode.h"

namespace glint::report {

// Counts the pixels with a colour that is not finite, and holds the first of them, row by row from the top.
struct NotFinite {
  uint64_t pixels = 0;
  uint32_t x = 0, y = 0;  // from the top left
  std::array<float, 3> rgb{};
  std::string stored_at{};  // the line whose store made that pixel so, such as "shade.comp:12", if known
};

// Returns nothing when all pixels are finite.
std::optional<NotFinite> not_finite(const pictures::ImageView& image);

// Returns text such as "3 of 4 096 pixels are not finite; the first at x 3, y 4 from the top left: nan 0 0,
// stored at shade.comp:12".
std::string text_of(const NotFinite& found, const pictures::ImageView& image);

}  // namespace glint::report
