// Reads picture sizes.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/image_size.h"

#include <cstdint>
#include <fmt/format.h>

#include "base/diagnostics.h"

namespace glint::app {
namespace {
using scenes::kMaxSide;

uint32_t number(const std::string& digits) {
  if (digits.empty() || digits.size() > 5 || digits.find_first_not_of("0123456789") != std::string::npos)
    return 0;
  return uint32_t(std::stoul(digits));
}
}  // namespace

void parse_size(const std::string& text, scenes::RenderParams& frame) {
  const size_t x = text.find('x');
  frame.width = number(text.substr(0, x));
  frame.height = x == std::string::npos ? 0 : number(text.substr(x + 1));
  if (frame.width < 1 || frame.height < 1 || frame.width > kMaxSide || frame.height > kMaxSide)
    throw UserError({}, fmt::format("--size is '{}', expected WIDTHxHEIGHT, each 1 to {}", text, kMaxSide),
                    "for example --size 128x128");
}

}  // namespace glint::app
