// Reads opacity micromaps: states of the parts of triangles as digits, and which triangle has which map.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/description/read_opacity.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <string>
#include <utility>
#include <vector>

namespace glint::pipeline {
namespace {

constexpr const char* kDigits =
    "each digit is a part: 0 transparent, 1 opaque, 2 or 3 for the any-hit shader, transparent or opaque "
    "where "
    "2 states are forced";

// Returns the map that a text of digits holds, or nothing when it is none.
std::optional<OpacityDescription::Map> map_of(const std::string& digits) {
  rt::MicromapFormat format{false, 0};
  while (format.level < rt::MicromapFormat::kMostLevels && format.num_states() < digits.size())
    ++format.level;
  const bool is_whole =
      format.num_states() == digits.size() &&
      std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '3'; });
  if (!is_whole) return {};
  format.two_states = std::all_of(digits.begin(), digits.end(), [](char c) { return c <= '1'; });
  OpacityDescription::Map out{format, std::vector<uint8_t>(format.bytes())};
  for (uint32_t i = 0; i < digits.size(); ++i) {
    const uint32_t bit = i * format.bits();
    out.states[bit / 8] = uint8_t(out.states[bit / 8] | uint32_t(digits[i] - '0') << bit % 8);
  }
  return out;
}

}  // namespace

std::optional<OpacityDescription> read_opacity(Reading& r, TableReader& t, const SourceLocation& where) {
  OpacityDescription out;
  out.where = where;
  const std::vector<std::string> maps = t.texts("opacity_maps");
  const std::vector<double> index = t.numbers("opacity_index");
  for (const std::string& digits : maps)
    if (auto map = map_of(digits))
      out.maps.push_back(std::move(*map));
    else
      r.errors.error(
          t.take("opacity_maps")->where,
          fmt::format("'{:.20}' is no map: it has {} characters, and a map has 1, 4, 16 and so on up to "
                      "4,096 digits from 0 to 3",
                      digits, digits.size()),
          kDigits);
  for (const double each : index) {
    const bool is_there = each == std::floor(each) && each >= -4 && each < double(maps.size());
    if (!is_there) {
      r.errors.error(t.take("opacity_index")->where,
                     fmt::format("{} names no map: there are {} maps, counted from 0", each, maps.size()),
                     "-1 to -4 stand for a whole triangle that is transparent, opaque or in the hands of the "
                     "any-hit shader (-3 and -4)");
      break;
    }
    out.index.push_back(int32_t(each));
  }
  if (maps.empty() && index.empty()) return {};
  return out;
}

}  // namespace glint::pipeline
