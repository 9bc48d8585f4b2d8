// Tests the contract of SampleWay for every registered way, and what sets each apart.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/sample_way.h"

#include <algorithm>
#include <set>

#include "tests/support/catch.h"

using namespace glint;
using namespace glint::pipeline;

namespace {

// Returns ten segments of 40 in a launch of 1000 blocks, of whose 25 cells the last five are dear.
SamplePlaces places() {
  SamplePlaces out{1000, 10, 40, {}};
  for (uint32_t cell = 0; cell < out.num_cells(); ++cell) out.costs.push_back(cell < 20 ? 1 + cell % 3 : 100);
  return out;
}

std::vector<uint32_t> begins(const std::string& name, uint64_t seed) {
  SplitMix numbers(seed);
  return PolicyChoice<SampleWay>(name.c_str()).make({})->begins(places(), numbers);
}

size_t num_dear(const std::vector<uint32_t>& all) {
  return size_t(std::ranges::count_if(all, [](uint32_t begin) { return begin >= 800; }));
}

}  // namespace

TEST_CASE("Every way places each segment within the launch, in order", "[contract]") {
  for (const std::string& name : Registry<SampleWay>::names())
    for (uint64_t seed = 1; seed <= 50; ++seed) {
      INFO(name << " " << seed);
      const std::vector<uint32_t> all = begins(name, seed);
      REQUIRE(all.size() == 10);
      REQUIRE(std::ranges::is_sorted(all));
      REQUIRE(all.back() + 40 <= 1000);
    }
}

TEST_CASE("Equal seeds place segments alike, others elsewhere, and each cell has its turn", "[contract]") {
  for (const std::string& name : Registry<SampleWay>::names()) {
    INFO(name);
    CHECK(begins(name, 1) == begins(name, 1));
    CHECK(begins(name, 1) != begins(name, 2));
    std::set<uint32_t> cells;
    for (uint64_t seed = 1; seed <= 300; ++seed)
      for (const uint32_t begin : begins(name, seed)) cells.insert(begin / 40);
    CHECK(cells.size() >= 24);
  }
}

TEST_CASE("By cost and by heat, dear places have their share with every seed; by chance they do not",
          "[contract]") {
  std::set<size_t> uniform;
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    CHECK(num_dear(begins("cost", seed)) == 2);  // a fifth of the cells
    CHECK(num_dear(begins("heat", seed)) == 2);
    CHECK(num_dear(begins("position", seed)) == 2);
    uniform.insert(num_dear(begins("uniform", seed)));
  }
  CHECK(uniform.size() > 2);
}
