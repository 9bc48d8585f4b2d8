// Compares what each lane of a laboratory launch stored with what it should have stored, for all machines and
// register limits.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstdint>
#include <functional>
#include <vector>

#include "tests/shaders/ray_lab.h"
#include "tests/support/catch.h"

namespace glint::test {

using Row = std::vector<uint32_t>;  // a lane's words from the first on; missing words are not checked

inline void check_lanes(RayLab& lab, const std::function<Row(uint32_t lane)>& expected) {
  for (const LabOptions& options : all_lab_options()) {
    INFO(to_string(options));
    const std::vector<uint32_t> got = lab.run(options);
    for (uint32_t lane = 0; lane < RayLab::kLanesUsed; ++lane) {
      const Row row = expected(lane);
      for (size_t i = 0; i < row.size(); ++i) {
        const uint32_t word = got[lane * lab.words_per_lane + i];
        INFO("x " << lane % RayLab::kWidth << " y " << lane / RayLab::kWidth << " word " << i << " as float "
                  << std::bit_cast<float>(word) << ", expected " << std::bit_cast<float>(row[i]));
        CHECK(word == row[i]);
      }
    }
  }
}

// Checks lanes by their column and row.
inline void check_pixels(RayLab& lab, const std::function<Row(uint32_t x, uint32_t y)>& expected) {
  check_lanes(lab, [&](uint32_t lane) { return expected(lane % RayLab::kWidth, lane / RayLab::kWidth); });
}

}  // namespace glint::test
