// Tests that the log of faults has one entry per place and kind, whatever the order in which lanes come.
// SPDX-License-Identifier: Apache-2.0
#include "exec/fault.h"
#include "tests/support/catch.h"

namespace glint::exec {
namespace {

void note(FaultLog& log, uint32_t pc, FaultKind kind, uint32_t launch_index, const std::string& what) {
  log.note(pc, kind, launch_index, [&] {
    return Fault{what, "a.comp:" + std::to_string(pc), {launch_index, 0, 0}};
  });
}

}  // namespace

TEST_CASE("faults at one place are one entry that tells the first time of the lowest launch index") {
  FaultLog log;
  for (const uint32_t index : {9u, 4u, 7u, 4u})
    note(log, 3, FaultKind::OutOfBounds, index, "wrong " + std::to_string(index));
  REQUIRE(log.in_order().size() == 1);
  const FaultLog::Entry entry = log.in_order()[0];
  CHECK(entry.count == 4);
  CHECK(entry.to_string() == "a.comp:3: fault: wrong 4\n  note: launch id (4, 0, 0), the first of 4 times");
}

TEST_CASE("logs of several cores add up to the log of one, in the order of launch indices") {
  FaultLog one, two, all;
  for (const uint32_t index : {5u, 1u, 8u, 2u, 8u})
    for (const uint32_t pc : {20u, 10u}) {
      if (pc == 10 && index == 1) continue;
      note(index % 2 ? one : two, pc, FaultKind::Misaligned, index, "m" + std::to_string(index));
      note(all, pc, FaultKind::Misaligned, index, "m" + std::to_string(index));
    }
  two.add(one);
  CHECK(two.to_string() == all.to_string());
  CHECK(two.count(FaultKind::Misaligned) == 9);
  CHECK(two.count(FaultKind::OutOfBounds) == 0);
  REQUIRE(two.in_order().size() == 2);
  CHECK(two.in_order()[0].pc == 20);  // index 1 comes before 2
  CHECK(two.in_order()[1].launch_index == 2);
}

TEST_CASE("a fault that ends the run is told after those that were let pass") {
  FaultLog log;
  const Fault last{"the end", "b.comp:9", {}};
  CHECK(log.with(last) == last.to_string());
  note(log, 1, FaultKind::Image, 0, "before");
  CHECK(log.with(last) ==
        "a.comp:1: fault: before\n  note: launch id (0, 0, 0)\n"
        "warning: faults let pass: 1, at 1 places; loads gave 0, stores were dropped\n" +
            last.to_string());
}

}  // namespace glint::exec
