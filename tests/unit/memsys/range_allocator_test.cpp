// Tests which ranges of numbers are handed out, and that gaps join.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/range_allocator.h"

#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "tests/support/catch.h"

using glint::mem::RangeAllocator;

TEST_CASE("ranges lie as low as possible, and gaps that touch are one") {
  RangeAllocator numbers(100);
  CHECK(numbers.take(10) == 0);
  CHECK(numbers.take(10) == 10);
  CHECK(numbers.take(10) == 20);
  CHECK(numbers.take(10) == 30);
  numbers.give_back(0, 10);
  numbers.give_back(20, 10);
  CHECK(numbers.num_taken() == 20);
  CHECK(numbers.take(11) == 40);
  numbers.give_back(10, 10);
  CHECK(numbers.take(30) == 0);
  CHECK(numbers.end() == 51);
  numbers.give_back(40, 11);
  numbers.give_back(30, 10);
  CHECK(numbers.end() == 30);
}

TEST_CASE("a count that no gap has room for is refused, and a count of 0 takes nothing") {
  RangeAllocator numbers(10);
  CHECK(numbers.take(4) == 0);
  CHECK(numbers.take(6) == 4);
  CHECK_FALSE(numbers.has_room(1));
  CHECK_FALSE(numbers.take(1).has_value());
  CHECK(numbers.take(0) == 10);
  numbers.give_back(0, 4);
  CHECK(numbers.has_room(4));
  CHECK_FALSE(numbers.has_room(5));
  CHECK_FALSE(numbers.take(5).has_value());
  CHECK(numbers.num_taken() == 6);
}

TEST_CASE("ranges in use never overlap, and all numbers come back") {
  RangeAllocator numbers(1000);
  std::vector<std::pair<uint64_t, uint64_t>> taken;
  std::set<uint64_t> used;
  uint32_t state = 1;
  const auto random = [&](uint32_t below) {
    return (state = state * 1664525 + 1013904223, state >> 16) % below;
  };
  for (int i = 0; i < 2000; ++i) {
    if (random(2) && !taken.empty()) {
      const size_t at = random(uint32_t(taken.size()));
      const auto [first, count] = taken[at];
      numbers.give_back(first, count);
      for (uint64_t n = first; n < first + count; ++n) used.erase(n);
      taken.erase(taken.begin() + std::ptrdiff_t(at));
    } else if (const uint64_t count = 1 + random(50); const auto first = numbers.take(count)) {
      for (uint64_t n = *first; n < *first + count; ++n) REQUIRE(used.insert(n).second);
      taken.emplace_back(*first, count);
    }
    REQUIRE(numbers.num_taken() == used.size());
    REQUIRE(numbers.end() == (used.empty() ? 0 : *used.rbegin() + 1));
  }
  for (const auto& [first, count] : taken) numbers.give_back(first, count);
  CHECK(numbers.end() == 0);
}
