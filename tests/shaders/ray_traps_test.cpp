// Tests ray tracing where it surprises: ends of rays by stage, bits that do not count.
// SPDX-License-Identifier: Apache-2.0
#include "tests/shaders/lane_checks.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

TEST_CASE(
    "gl_RayTmaxEXT is the candidate's distance in any-hit, the hit's in closest-hit, the ray's end in miss "
    "shaders, and moves with reports") {
  RayLab lab({"traps/ends.rgen",
              {"traps/ends.rmiss"},
              {{"traps/ends.rchit", "traps/ends.rahit", ""},
               {"traps/ends.rchit", "traps/ends.rahit", ""},
               {},
               {},
               {"traps/ends.rchit", "traps/ends.rahit", "traps/ends.rint"},
               {"traps/ends.rchit", "traps/ends.rahit", "traps/ends.rint"}},
              {}});
  check_pixels(lab, [](uint32_t x, uint32_t) {
    const uint32_t quad = bits(x < 4 ? 10.0f : 8.0f);
    switch (x) {
      case 0:
      case 1:
        return Row{0, 0, 0, 0, 0, 0, bits(64), 0};
      case 2:
      case 4:
        return Row{0, 0, 0, 0, 0, 0, quad, quad};
      case 3:
      case 5:
        return Row{0, 0, 0, 0, quad, quad, quad, quad};
      // The box is opaque: 9.5 is accepted, so 9.75 lies beyond the end.
      case 6:
        return Row{bits(64), bits(10.5f), bits(9.5f), bits(1009.5f), 0, 0, bits(9.5f), bits(9.5f)};
      // The any-hit shader ignores 9.5: the end stays where it was, and 9.75 is accepted.
      default:
        return Row{bits(64),    bits(10.5f), bits(10.5f), bits(9.75f),
                   bits(9.75f), bits(9.75f), bits(9.75f), bits(9.75f)};
    }
  });
}

TEST_CASE("of a trace's offset and stride count 4 bits, of its miss index 16, of its mask 8") {
  std::vector<LabShaders::Group> hit(8);
  hit[0] = {"tag1.rchit", "", ""};
  hit[1] = {"tag2.rchit", "", ""};
  hit[3] = {"tag3.rchit", "", ""};
  hit[4] = {"tag3.rchit", "", "pair.rint"};
  hit[5] = {"tag1.rchit", "", "pair.rint"};
  RayLab lab({"traps/masks.rgen", {"table.rmiss", ""}, hit, {}});
  check_pixels(lab, [](uint32_t x, uint32_t y) {
    const uint32_t lane = y * 8 + x, tags[8] = {1, 2, 0, 3, 3, 1, 0, 0};
    const bool is_masked = x == 4 || x == 5;  // the second instance's mask is 0x0f
    const uint32_t record = (x >= 6 ? 4 : 0) + (x & 1) * (1 + (lane >> 1 & 1)) + (lane & 1);
    if (x < 2 || is_masked || record >= 6) return Row{lane % 2 ? 0u : 30u};
    return Row{tags[record]};
  });
}

}  // namespace
}  // namespace glint::test
