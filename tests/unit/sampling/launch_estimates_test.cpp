// Tests the estimates from launches that stand for others.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/launch_estimates.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "tests/support/catch.h"

using namespace glint::pipeline;

namespace {

TimedLaunch timed(uint32_t launch, uint32_t cluster, double weight, double cycles) {
  TimedLaunch out{launch, cluster, weight};
  out.counts[size_t(BatchCount::Cycles)] = cycles;
  out.counts[size_t(BatchCount::Instructions)] = out.functional_instructions = 10;
  out.counts[size_t(BatchCount::L1Reads)] = 100;
  out.counts[size_t(BatchCount::L1Hits)] = 25;
  return out;
}

const Estimate& named(const std::vector<Estimate>& all, std::string_view name) {
  return *std::ranges::find(all, name, &Estimate::name);
}

}  // namespace

TEST_CASE("A launch counts as often as the launches that it stands for", "[launches]") {
  const std::vector<TimedLaunch> sample = {timed(0, 0, 1, 5000), timed(2, 1, 5, 100), timed(9, 1, 5, 100)};
  const std::vector<Estimate> all = estimate_launches(sample, {.instructions = 110});
  CHECK(named(all, "cycles").value == 6000);
  CHECK(named(all, "instructions").value == 110);
  CHECK(named(all, "instructions").low == 110);
  CHECK(named(all, "ipc").value == Approx(110.0 / 6000));
  CHECK(named(all, "l1_hit_rate").value == 0.25);
  CHECK(std::ranges::find(all, std::string_view("nodes"), &Estimate::name) == all.end());
}

TEST_CASE("An interval grows with the scatter within clusters, and not with that between them",
          "[launches]") {
  const auto width = [](double a, double b, double c, double d) {
    const std::vector<TimedLaunch> sample = {timed(0, 0, 5, a), timed(1, 0, 5, b), timed(2, 1, 5, c),
                                             timed(3, 1, 5, d)};
    const std::vector<Estimate> all = estimate_launches(sample, {.instructions = 200});
    return (named(all, "cycles").high - named(all, "cycles").low) / named(all, "cycles").value;
  };
  CHECK(width(100, 100, 100, 100) == Approx(width(100, 100, 900, 900)));
  CHECK(width(90, 110, 100, 100) > 1.5 * width(100, 100, 100, 100));
}

TEST_CASE("Where all launches were timed, the sum is exact", "[launches]") {
  const std::vector<TimedLaunch> sample = {timed(0, 0, 1, 120), timed(1, 0, 1, 80)};
  const std::vector<Estimate> all = estimate_launches(sample, {.instructions = 20});
  CHECK(named(all, "cycles").value == 200);
  CHECK(named(all, "cycles").low == 200);
  CHECK(named(all, "cycles").high == 200);
}

TEST_CASE("Instructions of the timing machine that differ from the functional ones are added", "[launches]") {
  std::vector<TimedLaunch> sample = {timed(0, 0, 2, 100), timed(1, 0, 2, 100)};
  for (TimedLaunch& one : sample) one.counts[size_t(BatchCount::Instructions)] += 3;
  const std::vector<Estimate> all = estimate_launches(sample, {.instructions = 40});
  CHECK(named(all, "instructions").value == 52);
}
