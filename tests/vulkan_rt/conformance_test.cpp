// Tests the recorded conformance set with its shaders unchanged: every ray of every mode, and the picture.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <iostream>

#include "tests/support/catch.h"
#include "tests/vulkan_rt/compare.h"
#include "tests/vulkan_rt/conformance_world.h"

namespace glint::vulkan_rt {
namespace {

bool skipped() {
  if (has_recording()) return false;
  std::cout << "SKIPPED: no recording in " << recording_folder()
            << "; GLINT_VULKAN_RT_DIR names another folder\n";
  return true;
}

// Compares hits without what depends on how many candidates were looked at before the hit was known. Where
// any-hit shaders ignore all (mode 2), each candidate is looked at once.
bool same_hit(Record a, Record b, const Mode& mode) {
  a.inters = b.inters = 0;
  if (mode.any_hit_mode != 2) a.anyhits = b.anyhits = a.hash = b.hash = 0;
  return std::memcmp(&a, &b, sizeof a) == 0;
}

TEST_CASE(
    "every recorded ray of every mode finds what the recorded driver found, or a checked rule says why not") {
  if (skipped()) return;
  const Recording& r = recording();
  const auto any_hit = GENERATE(as<std::string>(), "immediate", "deferred");
  for (size_t m = 0; m < r.modes.size(); ++m) {
    const std::vector<Record> ours = run_mode(r, r.modes[m], any_hit);
    const Tally tally = compare(r, r.modes[m], ours.data(), r.records.data() + m * r.rays_per_pattern);
    std::cout << fmt::format("{:<10} {}\n", any_hit, tally.line(r.modes[m].name));
    INFO(tally.line(r.modes[m].name) << tally.first_different);
    CHECK(tally.different == 0);
    // Only where rays aim at edges, or where any hit is accepted, may more than a few differ by choice.
    const bool any_first = (r.modes[m].ray_flags & 4) || r.modes[m].any_hit_mode == 3;
    const auto edges = tally.explained.find("shared edge"), firsts = tally.explained.find("any first hit");
    const uint32_t by_choice = (edges == tally.explained.end() ? 0 : edges->second) +
                               (firsts == tally.explained.end() ? 0 : firsts->second);
    CHECK((any_first || r.modes[m].pattern == 3 || by_choice <= r.rays_per_pattern / 1000));
  }
}

TEST_CASE("both any-hit modes find the same hit for every ray of every mode") {
  if (skipped()) return;
  const Recording& r = recording();
  uint32_t differ = 0, rays = 0;
  for (const Mode& mode : r.modes) {
    const std::vector<Record> immediate = run_mode(r, mode, "immediate"),
                              deferred = run_mode(r, mode, "deferred");
    // terminateRayEXT ends at whichever candidate comes first.
    const bool terminates = mode.any_hit_mode == 3;
    for (size_t i = 0; i < immediate.size(); ++i)
      differ += !terminates && !same_hit(immediate[i], deferred[i], mode);
    rays += terminates ? 0 : uint32_t(immediate.size());
  }
  std::cout << "any-hit modes  " << rays << " rays, " << differ << " with different hits\n";
  CHECK(rays > 0);
  CHECK(differ == 0);
}

TEST_CASE("the timing machine's records of a mode are those of the functional machine, bit for bit") {
  if (skipped()) return;
  const auto any_hit = GENERATE(as<std::string>(), "immediate", "deferred");
  Recording r = recording();
  const size_t last = std::min<size_t>(r.modes.size(), 1);
  for (size_t m = 0; m < last; ++m) {
    const std::vector<Record> functional = run_mode(r, r.modes[m], any_hit),
                              timing = run_mode(r, r.modes[m], any_hit, true);
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
