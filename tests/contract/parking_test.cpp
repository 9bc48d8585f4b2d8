// Tests the promises of Parking for every registered policy, and what each policy is for.
// SPDX-License-Identifier: Apache-2.0
#include "core/parking.h"

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/residency.h"
#include "tests/support/catch.h"

namespace glint::core {
namespace {

std::unique_ptr<Parking> made_parking(const std::string& name) {
  return PolicyChoice<Parking>(name.c_str()).make({});
}

}  // namespace

TEST_CASE("every parking answers the same views alike") {
  for (const std::string& name : Registry<Parking>::names()) {
    CAPTURE(name);
    const auto one = made_parking(name), two = made_parking(name);
    CHECK(one->is_used() == two->is_used());
    std::mt19937 random(7);
    for (Cycle now = 0; now < 2000; ++now) {
      const uint32_t parked = uint32_t(random() % 97), held = 1 + uint32_t(random() % 32);
      const Parking::View view{now,
                               1 + uint32_t(random() % 32),
                               32,
                               held,
                               parked,
                               parked ? uint32_t(random()) % parked : 0,
                               random() % 2 == 0};
      const bool gives_up = one->gives_up(view);
      REQUIRE(gives_up == two->gives_up(view));
      if (gives_up) REQUIRE(one->is_used());
    }
  }
}

TEST_CASE("the default is that warps keep their places, and it adds no slots") {
  CHECK(Registry<Parking>::names().size() >= 2);
  for (const std::string& name : Registry<Parking>::names()) {
    Params params;
    params.parking = PolicyChoice<Parking>(name.c_str());
    params.parking_lot.warps = 5;
    const bool is_default = name == Params{}.parking.name;
    CHECK(made_parking(name)->is_used() != is_default);
    CHECK(num_warp_slots(params, 16) == (is_default ? 16 : 21));
  }
}

TEST_CASE("at_rays keeps places that nobody wants") {
  const auto policy = made_parking("at_rays");
  Parking::View view{.now = 9, .lanes = 32, .places = 32, .held = 32};
  CHECK_FALSE(policy->gives_up(view));
  view.has_blocks = true;
  CHECK(policy->gives_up(view));
  view.has_blocks = false;
  view.parked = view.returning = 1;
  CHECK(policy->gives_up(view));
}

}  // namespace glint::core
