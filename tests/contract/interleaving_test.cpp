// Tests the promises of Interleaving for every registered policy, and what each policy is for.
// SPDX-License-Identifier: Apache-2.0
#include "core/interleaving.h"

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/params.h"
#include "tests/support/catch.h"

namespace glint::core {
namespace {

std::unique_ptr<Interleaving> made_interleaving(const std::string& name) {
  return PolicyChoice<Interleaving>(name.c_str()).make({});
}

}  // namespace

TEST_CASE("every interleaving answers the same views alike, in any order") {
  for (const std::string& name : Registry<Interleaving>::names()) {
    CAPTURE(name);
    const auto one = made_interleaving(name), two = made_interleaving(name);
    CHECK(one->is_used() == two->is_used());
    CHECK(one->is_used() == (name != Params{}.interleaving.name));
    std::mt19937 random(7);
    std::vector<Interleaving::View> views(500);
    for (Interleaving::View& view : views) {
      const uint32_t warps = 1 + uint32_t(random() % 16);
      view = {1 + uint32_t(random() % 31), 1 + uint32_t(random() % 31), warps,
              uint32_t(random() % (warps + 1))};
    }
    std::vector<bool> leaves, yields;
    for (const Interleaving::View& view : views) {
      leaves.push_back(one->leaves(view));
      yields.push_back(one->yields(view));
      if (leaves.back() || yields.back()) CHECK(one->is_used());
    }
    for (size_t i = views.size(); i-- > 0;) {
      REQUIRE(two->leaves(views[i]) == leaves[i]);
      REQUIRE(two->yields(views[i]) == yields[i]);
    }
  }
}

TEST_CASE("on_stall changes paths when as many of the warps wait as its parameter says") {
  PolicyChoice<Interleaving> choice("on_stall");
  const auto at_half = choice.make({});
  CHECK_FALSE(at_half->leaves({8, 8, 8, 3}));
  CHECK(at_half->leaves({8, 8, 8, 4}));
  CHECK_FALSE(at_half->yields({8, 8, 8, 8}));
}

}  // namespace glint::core
