// Tests which nodes the prefetcher `stack_trend` asks for after each visit of a ray.
// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "base/registry.h"
#include "rtunit/prefetcher.h"
#include "tests/support/catch.h"

namespace glint::rt::test {
namespace {

// Lets one ray push and pop entries that lie a sector apart, and tells a prefetcher of its visits.
struct Climb {
  mem::AddressSpace memory;
  Address base = memory.allocate("structure", 1 << 16);
  PrefetchQueue queue{64, memory, nullptr};
  std::unique_ptr<Prefetcher> policy =
      Registry<Prefetcher>::instance().entry("stack_trend").make_default({nullptr, queue, memory, 1});
  RayState ray;
  uint32_t pushed_so_far = 0;

  Climb() {
    ray.base = ray.ray.structure = base;
    ray.node_bytes = 32;
    ray.status = RayStatus::Traversing;
    ray.committed.t = 100;
    ray.stack_size = 0;
    push(1);
    policy->entered(0, 0, ray, 0);
  }
  void push(uint32_t entries, float t_enter = 1) {
    for (uint32_t i = 0; i < entries; ++i)
      ray.stack.set(size_t(ray.stack_size++), {node_ref(2 * ++pushed_so_far, NodeKind::Internal), t_enter});
  }
  // Makes a visit that pushes so many entries. Returns the numbers of the entries asked for, which count from
  // the first that was ever pushed.
  std::vector<uint32_t> visit(uint32_t entries, float t_enter = 1) {
    --ray.stack_size;
    push(entries, t_enter);
    policy->visited({0, 0, 0, ray, {}, 0, entries});
    std::vector<uint32_t> out;
    for (; !queue.empty(); queue.note_sent(true))
      out.push_back(uint32_t((queue.front() - base) / mem::kSectorBytes));
    return out;
  }
};

using Entries = std::vector<uint32_t>;

TEST_CASE("visits without a push ask for one, two and then all entries, each once, and a push ends it") {
  Climb climb;
  CHECK(climb.visit(6) == Entries{});      // entries 2 to 7; 7 is the next
  CHECK(climb.visit(0) == Entries{6});     // 7 is visited; one from the top
  CHECK(climb.visit(0) == Entries{5, 4});  // two from the top
  CHECK(climb.visit(0) == Entries{3, 2});  // all that are left
  CHECK(climb.visit(0) == Entries{});
  CHECK(climb.visit(3) == Entries{});  // 8 to 10 on top of 2
  CHECK(climb.visit(0) == Entries{9});
  CHECK(climb.visit(2) == Entries{});  // 11 and 12 on top of 8 and 2
  CHECK(climb.visit(0) == Entries{11});
  CHECK(climb.visit(0) == Entries{8});  // 2 was asked for not long ago
}

TEST_CASE("entries behind the hit are asked for only where the stack does not know its distances") {
  for (const bool retest : {true, false}) {
    Climb climb;
    climb.ray.rules.retest = retest;
    climb.visit(3, 50);
    climb.ray.committed.t = 10;
    CHECK(climb.visit(0).empty() == retest);
  }
}

}  // namespace
}  // namespace glint::rt::test
