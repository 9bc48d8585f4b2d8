// Tests when the schedulers of a core are due.
// SPDX-License-Identifier: Apache-2.0
#include "core/alarms.h"

#include "tests/support/catch.h"

using namespace glint;
using namespace glint::core;

TEST_CASE("a scheduler is due when somebody wakes it or its timer runs out") {
  Alarms alarms(GENERATE(3u, 4u, 8u));
  CHECK(alarms.due(0) == 0);
  CHECK(alarms.next(5) == kNever);
  alarms.sleep(1, 10);
  alarms.sleep(2, 12);
  CHECK(alarms.due(9) == 0);
  CHECK(alarms.next(5) == 10);
  CHECK(alarms.due(10) == 0b010);
  CHECK(alarms.due(12) == 0b110);
  CHECK(alarms.next(11) == 11);  // The first timer has run out, and its scheduler has had no turn yet.
  alarms.wake(0);
  CHECK(alarms.awake() == 0b001);
  CHECK(alarms.due(3) == 0b001);
  CHECK(alarms.next(3) == 3);
  alarms.sleep(0, kNever);
  CHECK(alarms.due(3) == 0);
}

TEST_CASE("every scheduler has a timer, however many a core has") {
  for (uint32_t count = 1; count <= kMaxSchedulers; ++count) {
    CAPTURE(count);
    Alarms alarms(count);
    for (uint32_t s = 0; s < count; ++s) alarms.sleep(s, 20 - s);
    CHECK(alarms.next(0) == 20 - (count - 1));
    for (uint32_t s = 0; s < count; ++s) CHECK((alarms.due(20 - s) >> s) == (1u << (count - s)) - 1);
    CHECK(alarms.due(20) == (1u << count) - 1);
  }
}

TEST_CASE("a sleep can become shorter and never longer") {
  Alarms alarms(4);
  alarms.sleep(3, 20);
  alarms.sleep_less(3, 30);
  CHECK(alarms.next(0) == 20);
  alarms.sleep_less(3, 15);
  CHECK(alarms.next(0) == 15);
}

TEST_CASE("a scheduler that watches a door is not due for it") {
  Alarms alarms(8);
  alarms.watch(4);
  CHECK(alarms.watching() == 0b10000);
  CHECK(alarms.due(100) == 0);
  alarms.watch_nothing(4);
  CHECK(alarms.watching() == 0);
}
