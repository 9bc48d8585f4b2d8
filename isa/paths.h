// Gives tests and the reference the op table as compiled for each SIMD path, and its families.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <iterator>
#include <span>
#include <string_view>

#include "isa/op_row.h"

namespace glint::isa {

enum class Path : uint8_t { Baseline, Avx2, Avx512, Count };
constexpr std::string_view name_of(Path p) {
  constexpr std::string_view kNames[] = {"baseline", "avx2", "avx512"};
  static_assert(std::size(kNames) == size_t(Path::Count));
  return kNames[size_t(p)];
}

// Returns whether this machine can run the handlers of `path`.
bool is_supported(Path path);

// Returns the table with the handlers of one path. Rows and indices are the same on all paths.
std::span<const OpRow> op_table(Path path);

// A chapter of the table: rows [first, first + count).
struct Family {
  std::string_view name;
  std::string_view doc;
  uint16_t first = 0, count = 0;
};
std::span<const Family> families();

}  // namespace glint::isa
