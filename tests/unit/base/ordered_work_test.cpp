// Tests work that threads do and one thread takes in order.
// SPDX-License-Identifier: Apache-2.0
#include "base/ordered_work.h"

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/catch.h"

using namespace glint;

TEST_CASE("results are taken in order at any number of threads") {
  for (const uint32_t threads : {1u, 2u, 3u, 8u})
    for (const size_t count : {size_t{0}, size_t{1}, size_t{5}, size_t{300}}) {
      std::vector<std::string> taken;
      OrderedWork<std::string> work(count, threads);
      work.run(
          [](size_t i) {
            // Early results take longest, so that later ones wait for them.
            std::this_thread::sleep_for(std::chrono::microseconds(i % 7 == 0 ? 200 : 0));
            return std::to_string(i);
          },
          [&](size_t i, std::string&& result) {
            CHECK(i == taken.size());
            taken.push_back(std::move(result));
          });
      REQUIRE(taken.size() == count);
      for (size_t i = 0; i < count; ++i) CHECK(taken[i] == std::to_string(i));
    }
}

TEST_CASE("results that wait are at most two for each thread") {
  constexpr uint32_t kThreads = 3;
  std::atomic<size_t> made = 0;
  OrderedWork<size_t> work(200, kThreads);
  work.run(
      [&](size_t i) {
        ++made;
        return i;
      },
      [&](size_t i, size_t&&) { CHECK(made <= i + 2 * kThreads); });
  CHECK(made == 200);
}

TEST_CASE("the first exception in order is thrown after the results before it") {
  for (const uint32_t threads : {1u, 4u}) {
    std::vector<size_t> taken;
    OrderedWork<size_t> work(100, threads);
    const auto run = [&] {
      work.run(
          [](size_t i) {
            if (i == 20 || i == 21) throw std::runtime_error(std::to_string(i));
            return i;
          },
          [&](size_t i, size_t&&) { taken.push_back(i); });
    };
    CHECK_THROWS_WITH(run(), "20");
    CHECK(taken.size() == 20);
  }
}

TEST_CASE("an exception of the taker ends the work") {
  std::atomic<size_t> made = 0;
  OrderedWork<size_t> work(100'000, 4);
  const auto run = [&] {
    work.run(
        [&](size_t i) {
          ++made;
          return i;
        },
        [](size_t, size_t&&) { throw std::runtime_error("full"); });
  };
  CHECK_THROWS_WITH(run(), "full");
  CHECK(made <= 9);
}
