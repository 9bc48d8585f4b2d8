// Tests that threads stand for the processors that the process may use.
// SPDX-License-Identifier: Apache-2.0
#include "base/host_threads.h"

#include <sched.h>

#include "tests/support/catch.h"

using namespace glint;

TEST_CASE("no number of threads stands for the processors that the process may use") {
  cpu_set_t before, one;
  REQUIRE(sched_getaffinity(0, sizeof before, &before) == 0);
  CHECK(host_threads(0) == uint32_t(CPU_COUNT(&before)));
  CHECK(host_threads(7) == 7);

  int first = 0;
  while (!CPU_ISSET(first, &before)) ++first;
  CPU_ZERO(&one);
  CPU_SET(first, &one);
  REQUIRE(sched_setaffinity(0, sizeof one, &one) == 0);
  const uint32_t found = host_threads(0);
  REQUIRE(sched_setaffinity(0, sizeof before, &before) == 0);
  CHECK(found == 1);
}
