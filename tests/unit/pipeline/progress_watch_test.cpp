// Tests to the cycle when a launch counts as one without progress.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/progress_watch.h"

#include "tests/support/catch.h"

using namespace glint;
using pipeline::ProgressWatch;

TEST_CASE("a budget is over a cycle after it, counted from the last change of memory") {
  ProgressWatch watch(10'000);
  const auto nothing = [] { return uint64_t{0}; };
  watch.look(0, false, nothing);
  watch.look(5000, true, nothing);
  CHECK(watch.since() == 5000);
  CHECK_FALSE(watch.is_over(15'000));
  CHECK(watch.is_over(15'001));
}

TEST_CASE("other progress counts too, and is asked for now and then only") {
  ProgressWatch watch(10'000);
  uint64_t done = 0;
  int asked = 0;
  const auto count = [&] { return ++asked, done; };
  for (Cycle now = 0; now < 8192; now += 49) watch.look(now, false, count);
  CHECK(asked == 2);
  CHECK(watch.since() == 0);
  done = 1;
  watch.look(9000, false, count);
  CHECK(watch.since() == 9000);
  CHECK_FALSE(watch.is_over(19'000));
}

TEST_CASE("a budget of 0 is never over") {
  ProgressWatch watch(0);
  watch.look(1'000'000'000, false, [] { return uint64_t{0}; });
  CHECK_FALSE(watch.is_over(1'000'000'000));
}
