// Checks that the log of prints keeps the same lines in whatever order they come.
// SPDX-License-Identifier: Apache-2.0
#include "exec/print_log.h"

#include <algorithm>
#include <fmt/format.h>
#include <random>
#include <thread>

#include "tests/support/catch.h"

namespace glint::test {
namespace {

// Returns the log that is expected when thread t of `threads` prints t % 4 lines and the limit is `limit`.
std::string expected(uint64_t threads, uint64_t limit) {
  std::string out;
  uint64_t count = 0;
  for (uint64_t t = 0; t < threads; ++t)
    for (uint64_t i = 0; i < t % 4; ++i, ++count)
      if (count < limit) out += fmt::format("thread {} line {}\n", t, i);
  if (count > limit)
    out += fmt::format("({} more messages not shown; the limit is {})\n", count - limit, limit);
  return out;
}

// Adds every line in two parts. Threads take turns at random.
void add_all(exec::PrintLog& log, uint64_t first, uint64_t threads, uint64_t stride, uint32_t seed) {
  std::vector<uint64_t> turns;
  for (uint64_t t = first; t < threads; t += stride) turns.insert(turns.end(), 2 * (t % 4), t);
  std::mt19937 random(seed);
  std::shuffle(turns.begin(), turns.end(), random);
  std::vector<uint64_t> done(threads);
  for (const uint64_t t : turns) {
    const uint64_t step = done[t]++;
    if (step % 2 == 0)
      log.add(t, fmt::format("thread {} ", t), false);
    else
      log.add(t, fmt::format("line {}{}", step / 2, step % 4 == 1 ? "\n" : ""), true);
  }
}

TEST_CASE("the first lines by thread are kept in whatever order they come, and the others are counted") {
  for (uint32_t seed = 0; seed < 40; ++seed)
    for (const uint64_t limit : {0, 1, 7, 59, 60, 61, 1000}) {
      INFO("seed " << seed << " limit " << limit);
      exec::PrintLog log(limit);
      add_all(log, 0, 41, 1, seed);
      CHECK(log.take() == expected(41, limit));
      CHECK(log.take().empty());
    }
}

TEST_CASE("host threads that add lines at the same time leave the same log") {
  for (uint32_t round = 0; round < 10; ++round) {
    exec::PrintLog log(100);
    std::vector<std::thread> hosts;
    for (uint64_t h = 0; h < 4; ++h) hosts.emplace_back([&, h] { add_all(log, h, 400, 4, round); });
    for (std::thread& host : hosts) host.join();
    CHECK(log.take() == expected(400, 100));
  }
}

TEST_CASE("a line that has not ended is shown, because a fault may have stopped its thread") {
  exec::PrintLog log(2);
  log.add(5, "half a line", false);
  CHECK(log.take() == "half a line\n");
}

}  // namespace
}  // namespace glint::test
