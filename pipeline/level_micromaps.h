// Gives the geometries of a bottom level their opacity micromaps, in one format for all of them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

#include "pipeline/device_micromaps.h"
#include "rtunit/structure/build.h"

namespace glint::pipeline {

// Owns the maps that it hands out: it lives until the level is built.
class LevelMicromaps {
 public:
  void add(size_t geometry, TakenMicromaps taken) { taken_.emplace_back(geometry, std::move(taken)); }
  void give_to(rt::BottomLevel& level);

 private:
  std::vector<std::pair<size_t, TakenMicromaps>> taken_;  // by the number of their geometry
  std::deque<rt::Micromaps> micromaps_;
};

}  // namespace glint::pipeline
