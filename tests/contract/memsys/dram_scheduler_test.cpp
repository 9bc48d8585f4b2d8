// Tests the contract of DramScheduler for every registered policy.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/dram_scheduler.h"

#include <random>
#include <vector>

#include "base/registry.h"
#include "tests/support/catch.h"

using namespace glint;
using namespace glint::mem;

namespace {

constexpr uint32_t kBanks = 8, kSlots = 32;

// Adds and picks requests at random. Returns the picks in order, and checks each.
std::vector<uint32_t> order_of(const std::string& name, uint32_t seed) {
  const auto scheduler = PolicyChoice<DramScheduler>(name.c_str()).make({kBanks, kSlots});
  std::mt19937 random(seed);
  std::vector<DramRequest> held(kSlots);
  std::vector<bool> in(kSlots);
  std::vector<uint32_t> picks;
  uint32_t count = 0;
  for (uint64_t age = 0; age < 3000 || count > 0;) {
    const uint32_t slot = random() % kSlots;
    if (age < 3000 && !in[slot]) {
      held[slot] = {uint32_t(random() % kBanks), uint32_t(random() % 4), age++, random() % 4 == 0};
      scheduler->add(slot, held[slot]);
      in[slot] = true, ++count;
    }
    if (random() % 2 && age < 3000) continue;
    uint32_t answered = 0;
    for (uint32_t bank = 0; bank < kBanks; ++bank) {
      const uint32_t picked =
          scheduler->pick(bank, random() % 5 == 4 ? DramScheduler::kClosed : random() % 4);
      if (picked == DramScheduler::kNone) continue;
      REQUIRE(picked < kSlots);
      REQUIRE(in[picked]);
      REQUIRE(held[picked].bank == bank);
      in[picked] = false, --count, ++answered;
      picks.push_back(picked);
    }
    if (count > 0) REQUIRE(answered > 0);
  }
  REQUIRE(picks.size() == 3000);
  return picks;
}

}  // namespace

TEST_CASE("every DRAM scheduler picks each request once, for its bank, and always makes progress") {
  REQUIRE(Registry<DramScheduler>::names() == std::vector<std::string>{"fcfs", "frfcfs", "write_drain"});
  for (const std::string& name : Registry<DramScheduler>::names()) {
    INFO(name);
    const std::vector<uint32_t> once = order_of(name, 11);
    CHECK(once == order_of(name, 11));
    CHECK(once != order_of(name, 12));
  }
}

TEST_CASE("a hit cap lets the oldest request through after that many row hits") {
  PolicyChoice<DramScheduler> choice("frfcfs");
  Config config;
  config.add_text("test", "hit_cap = 2\n");
  Diagnostics diagnostics;
  ConfigTable table = config.root(diagnostics);
  Registry<DramScheduler>::instance().entry("frfcfs").read(table, &choice);
  REQUIRE_FALSE(diagnostics.has_errors());
  const auto scheduler = choice.make({1, 8});
  scheduler->add(0, {0, 9, 0, false});
  for (uint32_t i = 1; i < 6; ++i) scheduler->add(i, {0, 5, i, false});
  CHECK(scheduler->pick(0, 5) == 1);
  CHECK(scheduler->pick(0, 5) == 2);
  CHECK(scheduler->pick(0, 5) == 0);
  CHECK(scheduler->pick(0, 9) == 3);
}

TEST_CASE("write_drain keeps writes back until enough wait, drains to its lower mark and then reads again") {
  PolicyChoice<DramScheduler> choice("write_drain");
  Config config;
  config.add_text("test", "high = 3\nlow = 1\n");
  Diagnostics diagnostics;
  ConfigTable table = config.root(diagnostics);
  Registry<DramScheduler>::instance().entry("write_drain").read(table, &choice);
  REQUIRE_FALSE(diagnostics.has_errors());
  const auto scheduler = choice.make({1, 16});
  for (uint32_t i = 0; i < 2; ++i) scheduler->add(i, {0, 5, i, true});
  for (uint32_t i = 2; i < 6; ++i) scheduler->add(i, {0, 5, i, false});
  CHECK(scheduler->pick(0, 5) == 2);  // two writes are older, which is not enough
  scheduler->add(6, {0, 5, 6, true});
  CHECK(scheduler->pick(0, 5) == 0);
  CHECK(scheduler->pick(0, 5) == 1);
  CHECK(scheduler->pick(0, 5) == 3);  // one write is left
  CHECK(scheduler->pick(0, 5) == 4);
  CHECK(scheduler->pick(0, 5) == 5);
  CHECK(scheduler->pick(0, 5) == 6);  // no read is left
}
