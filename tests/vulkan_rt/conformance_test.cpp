// The recorded conformance set, its shaders unchanged: every ray of every mode, and the picture.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>
#include <iostream>

#include "tests/support/catch.h"
#include "tests/vulkan_rt/compare.h"
#include "tests/vulkan_rt/conformance_world.h"

namespace glint::vulkan_rt {
namespace {

bool skipped() {
  if (has_recording()) return false;
  std::cout << "SKIPPED: no recording in " << recording_folder() << "; GLINT_VULKAN_RT_DIR names another folder\n";
  return true;
}

TEST_CASE("every recorded ray of every mode finds what the recorded driver found, or a checked rule says why not") {
  if (skipped()) return;
  const Recording& r = recording();
  for (size_t m = 0; m < r.modes.size(); ++m) {
    const std::vector<Record> ours = run_mode(r, r.modes[m]);
    const Tally tally = compare(r, r.modes[m], ours.data(), r.records.data() + m * r.rays_per_pattern);
    std::cout << tally.line(r.modes[m].name) << '\n';
    INFO(tally.line(r.modes[m].name) << tally.first_different);
    CHECK(tally.different == 0);
    // Only where rays aim at edges, or any hit will do, may more than a few differ by choice.
    const bool any_first = (r.modes[m].ray_flags & 4) || r.modes[m].any_hit_mode == 3;
    const auto edges = tally.explained.find("shared edge"), firsts = tally.explained.find("any first hit");
    const uint32_t by_choice = (edges == tally.explained.end() ? 0 : edges->second) + (firsts == tally.explained.end() ? 0 : firsts->second);
    CHECK((any_first || r.modes[m].pattern == 3 || by_choice <= r.rays_per_pattern / 1000));
  }
}

TEST_CASE("the timing machine's records of a mode are those of the functional machine, bit for bit") {
  if (skipped()) return;
  Recording r = recording();
  const size_t last = std::min<size_t>(r.modes.size(), 1);
  for (size_t m = 0; m < last; ++m) {
    const std::vector<Record> functional = run_mode(r, r.modes[m]), timing = run_mode(r, r.modes[m], true);
    CHECK(std::memcmp(functional.data(), timing.data(), functional.size() * sizeof functional[0]) == 0);
  }
}

TEST_CASE("the picture is the recorded one within 2 of 255 on all but one of a thousand pixels") {
  if (skipped()) return;
  const Recording& r = recording();
  if (r.image.empty()) {
    std::cout << "SKIPPED: no picture in " << recording_folder() << '\n';
    return;
  }
  const std::vector<float> ours = run_image(r, r.image_size);
  uint32_t off = 0;
  const uint32_t pixels = r.image_size * r.image_size;
  for (uint32_t p = 0; p < pixels; ++p) {
    float worst = 0;
    for (uint32_t c = 0; c < 3; ++c) worst = std::max(worst, std::fabs(ours[4 * p + c] - r.image[4 * p + c]));
    off += !(worst <= 2.0f / 255.0f);
  }
  std::cout << "picture         " << pixels << " pixels, " << off << " off by more than 2/255\n";
  CHECK(off <= pixels / 1000);
}

}  // namespace
}  // namespace glint::vulkan_rt
