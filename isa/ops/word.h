// Joins names and sentences of generated rows at compile time.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <initializer_list>
#include <string_view>

#include "isa/op_makers.h"

namespace glint::isa::GLINT_ISA_PATH {

// Holds text in its own storage. A row's string_view may point to a Word that is a constant.
struct Word {
  std::array<char, 112> at{};
  size_t length = 0;
  constexpr Word() = default;
  constexpr Word(std::initializer_list<std::string_view> parts) {
    for (const std::string_view part : parts)
      for (const char c : part) at[length++] = c;
  }
  constexpr std::string_view view() const { return {at.data(), length}; }
};

}  // namespace glint::isa::GLINT_ISA_PATH
