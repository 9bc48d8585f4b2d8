// The recorded conformance set in every node format: the same records for every ray of every mode.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstring>
#include <iostream>

#include "base/registry.h"
#include "rtunit/node_format.h"
#include "tests/support/catch.h"
#include "tests/vulkan_rt/compare.h"
#include "tests/vulkan_rt/conformance_world.h"

namespace glint::vulkan_rt {
namespace {

constexpr uint32_t kAnyHitIgnores = 2, kAnyHitTerminates = 3;  // any-hit modes of the recording's shaders

// But for what depends on the order of visits: how many candidates were looked at before the hit was known. Where any-hit
// shaders ignore all, each candidate is looked at once.
bool same_hit(Record a, Record b, const Mode& mode) {
  a.inters = b.inters = 0;
  if (mode.any_hit_mode != kAnyHitIgnores) a.anyhits = b.anyhits = a.hash = b.hash = 0;
  return std::memcmp(&a, &b, sizeof a) == 0;
}

TEST_CASE("every node format finds what the recorded driver found, and the hits of bvh6 bit for bit") {
  if (!has_recording()) {
    std::cout << "SKIPPED: no recording in " << recording_folder() << "; GLINT_VULKAN_RT_DIR names another folder\n";
    return;
  }
  const Recording& r = recording();
  for (const Mode& mode : r.modes) {
    const std::vector<Record> reference = run_mode(r, mode, "immediate");
    const Record* recorded = r.records.data() + size_t(&mode - r.modes.data()) * r.rays_per_pattern;
    for (const std::string& format : Registry<rt::NodeFormat>::names()) {
      if (format == "bvh6") continue;
      const std::vector<Record> ours = run_mode(r, mode, "immediate", false, format);
      uint32_t differ = 0;
      for (size_t i = 0; i < ours.size(); ++i)
        differ += mode.any_hit_mode != kAnyHitTerminates && !same_hit(ours[i], reference[i], mode);
      const Tally tally = compare(r, mode, ours.data(), recorded);
      std::cout << fmt::format("{:<10} {}, {} unlike bvh6\n", format, tally.line(mode.name), differ);
      INFO(format << ' ' << tally.line(mode.name) << tally.first_different);
      CHECK(tally.different == 0);
      CHECK(differ == 0);
    }
  }
}

}  // namespace
}  // namespace glint::vulkan_rt
