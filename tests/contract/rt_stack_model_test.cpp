// Tests that every registered stack model keeps the promises of rtunit/stack_model.h.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include "base/registry.h"
#include "rtunit/stack_model.h"
#include "rtunit/traversal/traversal.h"
#include "tests/support/catch.h"
#include "tests/support/rt_scenes.h"

namespace glint::rt::test {
namespace {

std::unique_ptr<StackModel> model_of(const std::string& name) {
  return Registry<StackModel>::instance().entry(name).make_default({});
}

// Holds a ray that does nothing but push and pop.
struct Walker {
  RayState ray;
  RayPath path;
  explicit Walker(const StackModel& model) {
    ray.status = RayStatus::Traversing;
    ray.stack_size = 1;
    path.parent[0] = RayPath::kNoParent;
    if (model.keeps_path()) ray.path = &path;
  }
  void visit(int pops, int pushes) {
    const auto depth = uint8_t(path.parent[size_t(ray.stack_size) - 1] + 1);
    ray.stack_size = int16_t(ray.stack_size - pops);
    for (; pushes > 0 && ray.stack_size < kStackEntries; --pushes)
      path.parent[size_t(ray.stack_size++)] = depth;
  }
};

TEST_CASE("every stack model keeps the next entry on chip, and fills what it has spilled and nothing else") {
  const auto names = Registry<StackModel>::names();
  REQUIRE(names.size() >= 3);
  for (const std::string& name : names) {
    CAPTURE(name);
    const auto model = model_of(name);
    Random random{3};
    int most_on_chip = 0;
    for (int round = 0; round < 300; ++round) {
      Walker walker(*model);
      std::set<int> in_memory, shared;  // rows
      const SharedArea area = model->shared_area();
      const auto settle = [&] {
        const StackWork work = model->settle(walker.ray);
        for (int i = 1; i <= work.loads; ++i) REQUIRE(shared.erase(work.shared_row - i) == 1);
        for (int i = 1; i <= work.fills; ++i) REQUIRE(in_memory.erase(work.row - i) == 1);
        int spilled = 0;
        for (int i = 0; i < work.stores; ++i) {
          if (work.stores - i <= work.spills) REQUIRE(shared.erase(work.row + spilled++) == 1);
          REQUIRE(shared.insert(work.shared_row + i).second);
          REQUIRE(shared.size() <= area.rows);
        }
        REQUIRE((area.rows == 0 || spilled == work.spills));
        for (int i = 0; i < work.spills; ++i) REQUIRE(in_memory.insert(work.row + i).second);
        REQUIRE(walker.ray.stack_in_memory == (area.rows ? 4 * int(in_memory.size()) : 0));
        for (const int row : in_memory) REQUIRE(row < int(model->rows()));
        const int on_chip = walker.ray.stack_size - walker.ray.stack_off_chip;
        REQUIRE((on_chip > 0 || walker.ray.stack_size == 0));
        REQUIRE((walker.ray.stack_size > 0 || walker.ray.stack_off_chip == 0));
        most_on_chip = std::max(most_on_chip, on_chip);
        REQUIRE(work.replays < 250);
      };
      settle();
      while (walker.ray.stack_size > 0) {
        const int deep = random.below(10) ? 1 : 1 + int(random.below(uint32_t(walker.ray.stack_size)));
        walker.visit(deep,
                     random.below(100) < 60 - uint32_t(walker.ray.stack_size) / 4 ? int(random.below(5)) : 0);
        settle();
      }
      CHECK((in_memory.empty() && shared.empty()));
    }
    if (name == "full")
      CHECK(most_on_chip > 20);
    else
      CHECK(most_on_chip == 8);
  }
}

TEST_CASE("a short stack spills four entries when a ninth comes, and fills them when none is left on chip") {
  const auto model = model_of("short_stack");
  Walker walker(*model);
  walker.visit(1, 8);
  CHECK(model->settle(walker.ray).spills == 0);
  walker.visit(0, 1);
  StackWork work = model->settle(walker.ray);
  CHECK((work.spills == 1 && work.row == 0 && walker.ray.stack_off_chip == 4));
  walker.visit(4, 0);
  CHECK(model->settle(walker.ray).fills == 0);
  walker.visit(1, 0);
  work = model->settle(walker.ray);
  CHECK((work.fills == 1 && work.row == 1 && walker.ray.stack_off_chip == 0));
}

TEST_CASE("a stack with a shared area fills that before it spills, and empties it before it fills") {
  const auto model = model_of("shared_memory");  // 8 entries on chip, and 8 in the area
  CHECK(model->shared_area().bytes_per_warp() == 32 * 8 * 8);
  Walker walker(*model);
  walker.visit(1, 17);
  StackWork work = model->settle(walker.ray);
  CHECK((work.stores == 3 && work.spills == 1 && work.row == 0 && work.shared_row == 0));
  CHECK((walker.ray.stack_off_chip == 12 && walker.ray.stack_in_memory == 4));
  walker.visit(5, 0);
  work = model->settle(walker.ray);
  CHECK((work.loads == 1 && work.shared_row == 3 && work.fills == 0));
  walker.visit(4, 0);
  work = model->settle(walker.ray);
  CHECK((work.loads == 1 && work.shared_row == 2 && work.fills == 0));
  walker.visit(4, 0);
  work = model->settle(walker.ray);
  CHECK((work.loads == 0 && work.fills == 1 && work.row == 1));
  CHECK((walker.ray.stack_off_chip == 0 && walker.ray.stack_in_memory == 0));
}

TEST_CASE("rows of a lane lie in one quarter of the banks when interleaved, and in turn in all otherwise") {
  const SharedArea interleaved{2, 1, 23, true}, apart{2, 1, 23, false};
  CHECK((interleaved.quarter(0, 5) == 1 && interleaved.quarter(1, 5) == 1));
  CHECK((apart.quarter(0, 5) == 2 && apart.quarter(1, 5) == 3 && apart.quarter(2, 5) == 2));
  CHECK(apart.quarter(0, 7) == apart.quarter(0, 5));
}

TEST_CASE("a ray that ends at its first hit leaves its stack where it is") {
  const auto model = model_of("short_stack");
  Walker walker(*model);
  walker.visit(1, 30);
  CHECK(model->settle(walker.ray).spills == 6);
  walker.ray.status = RayStatus::Done;
  walker.ray.stack_size = 0;
  SECTION("without reading it") {
    walker.ray.ray.flags = ray_flag::kTerminateOnFirstHit;
    walker.ray.committed.instance = 1;
    CHECK(model->settle(walker.ray).fills == 0);
  }
  SECTION("but one whose entries lie behind its hit reads them to know it") {
    CHECK(model->settle(walker.ray).fills == 6);
  }
  CHECK(walker.ray.stack_off_chip == 0);
}

TEST_CASE("a restart visits the nodes above the entry that was forgotten, from the root on") {
  const auto model = model_of("restart_trail");
  Walker walker(*model);
  walker.visit(1, 5);  // children of the root, at depth 0
  model->settle(walker.ray);
  walker.visit(1, 5);  // of its last child, at depth 1: nine entries, one is forgotten
  CHECK(model->settle(walker.ray).replays == 0);
  CHECK(walker.ray.stack_off_chip == 1);
  for (int i = 0; i < 7; ++i) {
    walker.visit(1, 0);
    REQUIRE(model->settle(walker.ray).replays == 0);
  }
  walker.visit(1, 0);
  CHECK(model->settle(walker.ray).replays == 1);  // the root alone
  CHECK(walker.ray.stack_off_chip == 0);
}

}  // namespace
}  // namespace glint::rt::test
