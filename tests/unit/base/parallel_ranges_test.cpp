// Tests work on ranges that several threads share.
// SPDX-License-Identifier: Apache-2.0
#include "base/parallel_ranges.h"

#include <stdexcept>
#include <vector>

#include "tests/support/catch.h"

using namespace glint;

TEST_CASE("every thing is in one range, and ranges are the same at any number of threads") {
  for (const uint32_t threads : {1u, 2u, 8u})
    for (const size_t count : {size_t{0}, size_t{1}, size_t{10}, size_t{11}, size_t{1000}}) {
      std::vector<size_t> first(count, count);
      parallel_ranges(count, 10, threads, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) first[i] = begin;
      });
      for (size_t i = 0; i < count; ++i) REQUIRE(first[i] == i / 10 * 10);
    }
}

TEST_CASE("of several ranges that throw, the first one's exception leaves") {
  for (const uint32_t threads : {1u, 2u, 8u})
    for (int round = 0; round < 20; ++round)
      CHECK_THROWS_WITH(parallel_ranges(1000, 10, threads,
                                        [&](size_t begin, size_t) {
                                          if (begin >= 500) throw std::runtime_error(std::to_string(begin));
                                        }),
                        "500");
}
