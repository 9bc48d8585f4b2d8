// Writes the micromaps of all geometries in the format that can hold each of them.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/level_micromaps.h"

namespace glint::pipeline {

void LevelMicromaps::give_to(rt::BottomLevel& level) {
  rt::MicromapFormat format{true, 0};
  for (const auto& [geometry, taken] : taken_)
    for (const TakenMicromaps::Map& each : taken.maps) format = common_format(format, each.format);
  for (const auto& [geometry, taken] : taken_)
    level.geometries[geometry].micromaps = &micromaps_.emplace_back(in_format(taken, format));
}

}  // namespace glint::pipeline
