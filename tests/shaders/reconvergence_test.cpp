// Tests that lanes meet again after every construct, and that reaching unreachable code stops the run.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <functional>

#include "base/diagnostics.h"
#include "tests/shaders/compute_lab.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

constexpr uint32_t kAll = 0xffff'ffff;

uint32_t lanes_where(const std::function<bool(uint32_t)>& holds) {
  uint32_t mask = 0;
  for (uint32_t lane = 0; lane < 32; ++lane) mask |= uint32_t(holds(lane)) << lane;
  return mask;
}

uint32_t leave_early(uint32_t x) {
  for (uint32_t i = 0; i < 4; ++i) {
    if (x == i) return i * 10;
    if ((x & 3) == 0) continue;
    if ((x & 3) == 1 && i == 2) return 7;
    if ((x & 3) == 2 && x <= 20) return 8;
    if (x > 28 && i == 1) return 9;
  }
  return 99;
}

Words expected(uint32_t x) {
  Words row{lanes_where([&](uint32_t l) { return (l & 1) == (x & 1); }),
            kAll,
            leave_early(x),
            kAll,
            lanes_where([&](uint32_t l) { return l % 5 >= x % 5; }),
            kAll,
            kAll};
  const uint32_t last = x % 3 == 2 ? 1 : 2;  // the last iteration in which this lane did not continue
  row.push_back(lanes_where([&](uint32_t l) { return l % 3 != last; }));
  row.push_back(kAll);
  const uint32_t label = x & 3;
  if (label == 1 || (label == 3 && x < 16))
    row.push_back(0);
  else
    row.push_back(lanes_where([&](uint32_t l) { return (l & 3) == label && (label != 3 || l >= 16); }));
  row.push_back(kAll);
  row.push_back(x > 10 ? x % 4 + 1 : 5);
  row.push_back(kAll);
  row.push_back(kAll);
  row.push_back(x < 8 ? 0xff : 0);
  row.push_back(x < 8 && x % 2 == 0 ? 0x55 : 0);
  row.push_back(kAll);
  if (x < 24) row.push_back(0x00ff'ffff);
  if (x < 24 && x >= 4) row.push_back(0x00ff'fff0);
  return row;
}

TEST_CASE(
    "lanes meet after each if, loop, switch, early return and short circuit, and continue together at a "
    "loop's step") {
  for (const LabOptions& options : compute_lab_options()) {
    INFO(to_string(options));
    ComputeLab lab("traps/reconverge.comp");
    lab.buffers[0] = Words(32 * 24);
    lab.run(options);
    for (uint32_t lane = 0; lane < 32; ++lane) {
      const Words row = expected(lane);
      for (size_t i = 0; i < row.size(); ++i) {
        INFO("lane " << lane << " word " << i);
        CHECK(lab.buffers[0][lane * 24 + i] == row[i]);
      }
    }
  }
}

TEST_CASE("what a module calls unreachable stops the run when a lane comes there") {
  for (const LabOptions& options : compute_lab_options()) {
    INFO(to_string(options));
    ComputeLab lab("traps/unreachable.spvasm");
    lab.buffers[0] = Words(4);
    CHECK_THROWS_WITH(lab.run(options), Catch::Contains("trap"));
  }
}

TEST_CASE(
    "remainders have the dividend's sign, moduli the divisor's; a switch over 64 bits compares all of them "
    "and falls through") {
  for (const LabOptions& options : compute_lab_options()) {
    INFO(to_string(options));
    ComputeLab lab("traps/remainders.spvasm");
    const auto u = [](int32_t x) { return uint32_t(x); };
    const auto f = [](float x) { return std::bit_cast<uint32_t>(x); };
    lab.buffers[1] = {u(-7), 3, 0, 1, 7, u(-3), kAll, kAll, u(-7), u(-3), 0, 0, 6, 3, 1, 0};
    lab.buffers[0] = Words(16);
    lab.run(options);
    CHECK(lab.buffers[0] ==
          Words{u(-1), 2, f(-1), 110, 1, u(-2), f(1), 10, u(-1), u(-1), f(-1), 1000, 0, 0, f(0), 1000});
  }
}

}  // namespace
}  // namespace glint::test
