// Tests ray queries in shaders: candidates, decisions and every value of the committed hit.
// SPDX-License-Identifier: Apache-2.0
#include "tests/shaders/lane_checks.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

// Returns the row of a lane for the laboratory's scene as queries.rgen walks it: it accepts triangle 0 of the
// quads that are not opaque, and in boxes a hit at distance 9.75.
Row walked(uint32_t x, uint32_t y) {
  const bool hits = x >= 2, box = x >= 6, opaque = x % 2 == 0;
  const uint32_t primitive = box ? y : y < 3 ? 0 : 1, instance = x < 4 ? 0 : x < 6 ? 1 : 2;
  const bool committed = hits && (box || opaque || primitive == 0);
  const uint32_t triangles = hits && !box && !opaque, boxes = hits && box;
  Row row(16, 0);
  row[0] = !committed ? 0 : box ? 2 : 1;
  row[1] = triangles | boxes << 8 | (boxes && opaque ? 1u : 0u) << 16;
  row[2] = triangles || boxes ? primitive + 1 : 0;
  row[3] = bits(!committed ? 100 : box ? 9.75f : instance == 1 ? 8 : 10);
  row[4] = bits(0.125f + float(x) + 0.5f - 1);
  if (!committed) return row;
  row[5] = (instance + 1) * 100 << 8 | instance << 4 | (instance == 2 ? 4 : 0);
  row[6] = uint32_t(!opaque) << 8 | primitive;
  row[7] = bits(float(2 * (instance + 1)));
  row[8] = bits(-float(2 * (instance + 1)));
  row[9] = bits(float(x % 2) + 0.5f);
  row[11] = box ? 7 : 1;
  const double px = 0.5, py = (y + 0.5) / 6;
  row[12] = bits(box ? -1.0f : float(y < 3 ? py : py - px));
  return row;
}

TEST_CASE(
    "a ray query offers what is not opaque, commits what the shader takes, and tells everything about it") {
  RayLab lab({"queries.rgen", {}, {}, {}});
  lab.words_per_lane = 16;
  for (const LabOptions& options : all_lab_options()) {
    INFO(to_string(options));
    const std::vector<uint32_t> got = lab.run(options);
    for (uint32_t lane = 0; lane < RayLab::kLanesUsed; ++lane) {
      const uint32_t x = lane % RayLab::kWidth, y = lane / RayLab::kWidth;
      const Row row = walked(x, y);
      for (size_t i = 0; i < row.size(); ++i) {
        const uint32_t word = got[lane * 16 + i];
        INFO("x " << x << " y " << y << " word " << i << " is " << word << ", as float "
                  << std::bit_cast<float>(word));
        if (i == 12)
          CHECK(double(std::bit_cast<float>(word)) ==
                Approx(double(std::bit_cast<float>(row[i]))).margin(1e-6));
        else
          CHECK(word == row[i]);
      }
    }
  }
}

}  // namespace
}  // namespace glint::test
