// Tests the recorded conformance set in every node format: the same records for every ray of every mode.
// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <fmt/format.h>
#include <iostream>

#include "base/registry.h"
#include "rtunit/node_format.h"
#include "tests/support/catch.h"
#include "tests/vulkan_rt/compare.h"
#include "tests/vulkan_rt/conformance_world.h"

namespace glint::vulkan_rt::formats_test {
namespace {

constexpr uint32_t kAnyHitIgnores = 2, kAnyHitTerminates = 3;  // any-hit modes of the recording's shaders

// Compares hits without what depends on the order of visits: how many candidates were looked at before the
// hit was known. Where any-hit shaders ignore all, each candidate is looked at once.
bool same_hit(Record a, Record b, const Mode& mode) {
  a.inters = b.inters = 0;
  if (mode.any_hit_mode != kAnyHitIgnores) a.anyhits = b.anyhits = a.hash = b.hash = 0;
  return std::memcmp(&a, &b, sizeof a) == 0;
}

// Returns the first rays of every pattern. Two walks of the whole set in every format would take a minute.
Recording first_rays(const Recording& all, uint32_t rays) {
  if (all.rays_per_pattern <= rays) return all;
  const auto cut = [&](const auto& from) {
    auto out = from;
    out.clear();
    for (size_t at = 0; at < from.size(); at += all.rays_per_pattern)
      out.insert(out.end(), from.begin() + ptrdiff_t(at), from.begin() + ptrdiff_t(at + rays));
    return out;
  };
  Recording out = all;
  out.rays = cut(all.rays), out.records = cut(all.records), out.rays_per_pattern = rays;
  return out;
}

void check_formats(const Recording& r, const std::string& any_hit) {
  for (const Mode& mode : r.modes) {
    const std::vector<Record> reference = run_mode(r, mode, "immediate");
    const Record* recorded = r.records.data() + size_t(&mode - r.modes.data()) * r.rays_per_pattern;
    for (const std::string& format : Registry<rt::NodeFormat>::names()) {
      if (format == "bvh6") continue;
      const std::vector<Record> ours = run_mode(r, mode, any_hit, false, format);
      uint32_t differ = 0;
      for (size_t i = 0; i < ours.size(); ++i)
        differ += mode.any_hit_mode != kAnyHitTerminates && !same_hit(ours[i], reference[i], mode);
      const Tally tally = compare(r, mode, ours.data(), recorded);
      std::cout << fmt::format("{:<10} {:<10} {}, {} unlike bvh6\n", format, any_hit, tally.line(mode.name),
                               differ);
      INFO(format << ' ' << any_hit << ' ' << tally.line(mode.name) << tally.first_different);
      CHECK(tally.different == 0);
      CHECK(differ == 0);
    }
  }
}

bool skipped() {
  if (has_recording()) return false;
  std::cout << "SKIPPED: no recording in " << recording_folder()
            << "; GLINT_VULKAN_RT_DIR names another folder\n";
  return true;
}

TEST_CASE("every node format finds what the recorded driver found, and the hits of bvh6 bit for bit") {
  if (!skipped()) check_formats(recording(), "immediate");
}

TEST_CASE("every node format finds in the deferred any-hit mode what bvh6 finds in the immediate one") {
  constexpr uint32_t kRays = 1024;  // of each pattern
  if (!skipped()) check_formats(first_rays(recording(), kRays), "deferred");
}

}  // namespace
}  // namespace glint::vulkan_rt::formats_test
