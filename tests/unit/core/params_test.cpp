// Tests occupancy: how many warps and blocks a core holds.
// SPDX-License-Identifier: Apache-2.0
#include <tuple>
#include <vector>

#include "core/residency.h"
#include "tests/support/catch.h"

namespace glint::core {

TEST_CASE("registers limit the resident warps, rounded up to eights") {
  Params params;
  params.warps = 32;
  params.registers = 32768;

  CHECK(occupancy(params, 1) == 32);
  CHECK(occupancy(params, 32) == 32);  // 32 * 32 * 32 fills the file exactly
  CHECK(occupancy(params, 33) == 25);  // 40 per lane would give 25.6
  CHECK(occupancy(params, 64) == 16);
  CHECK(occupancy(params, 255) == 4);
  params.warps = 3;
  CHECK(occupancy(params, 255) == 3);
}

TEST_CASE("a program that does not fit once is reported with the number that would do") {
  Params params;
  params.registers = 1024;
  Diagnostics fits, too_large;

  check(params, 32, fits);
  check(params, 33, too_large);

  CHECK_FALSE(fits.has_errors());
  REQUIRE(too_large.has_errors());
  CHECK(too_large.messages()[0].find("core.registers to 1280") != std::string::npos);
}

TEST_CASE("what is used up first limits the blocks of a core") {
  using Limit = Residency::Limit;
  Params params;
  params.warps = 32;
  params.registers = 32768;
  params.blocks = 16;
  params.shared_bytes = 65536;
  const auto of = [&](LaunchNeeds needs) {
    const Residency r = residency(params, needs);
    return std::tuple{r.limit, r.blocks, r.warps};
  };

  CHECK(of({32, 1, 0, false}) == std::tuple{Limit::Warps, 32u, 32u});
  CHECK(of({33, 1, 0, false}) == std::tuple{Limit::Registers, 25u, 25u});
  CHECK(of({32, 1, 0, true}) == std::tuple{Limit::Blocks, 16u, 16u});
  // All limits are met at once, and the first is named.
  CHECK(of({32, 2, 4096, true}) == std::tuple{Limit::Warps, 16u, 32u});
  CHECK(of({32, 2, 4097, true}) == std::tuple{Limit::SharedMemory, 15u, 30u});
  CHECK(of({64, 5, 0, true}) == std::tuple{Limit::Registers, 3u, 15u});
  CHECK(of({16, 5, 0, true}) == std::tuple{Limit::Warps, 6u, 30u});
}

TEST_CASE("units have their keys under the names of the instruction table") {
  std::vector<std::string> keys;
  for (const ParamInfo& info : describe_params(Units{}))
    if (info.key.ends_with(".latency")) keys.push_back(info.key.substr(0, info.key.size() - 8));

  REQUIRE(keys.size() == size_t(isa::Unit::Count));
  for (size_t i = 0; i < keys.size(); ++i) CHECK(keys[i] == name_of(isa::Unit(i)));
}

TEST_CASE("by_unit gives each unit its own parameters") {
  Units units;
  units.sfu.latency = 99;
  units.rt_unit.latency = 77;

  CHECK(units.by_unit()[size_t(isa::Unit::Sfu)].latency == 99);
  CHECK(units.by_unit()[size_t(isa::Unit::RtUnit)].latency == 77);
}

}  // namespace glint::core
