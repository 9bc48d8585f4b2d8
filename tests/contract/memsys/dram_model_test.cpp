// Tests the contract of DramModel for every registered model, and the arithmetic of the simple one.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <random>
#include <vector>

#include "base/registry.h"
#include "memsys/dram/dram_params.h"
#include "tests/support/catch.h"

using namespace glint;
using namespace glint::mem;

namespace {

struct DramOutcome {
  std::map<Address, Cycle> back;
  uint64_t busy = 0, clocks = 0, active = 0;
  bool operator==(const DramOutcome&) const = default;
};

// Runs 2000 requests in bursts. With `often` the model is advanced in every cycle, not only when it asks for
// it.
DramOutcome exercise(const std::string& name, bool often) {
  const DramParams params;
  stats::Group root(nullptr, "test");
  const auto model = PolicyChoice<DramModel>(name.c_str()).make({params, 256, 1365.0, &root});
  std::mt19937 random(4);
  DramOutcome out;
  std::map<Address, Cycle> asked;
  Cycle now = 0, next_burst = 0;
  uint32_t added = 0, burst = 0;
  for (;;) {
    model->advance(now);
    for (; !model->returns().empty() && model->returns().front().ready <= now; model->returns().pop()) {
      const DramReturn& read = model->returns().front();
      REQUIRE(asked.contains(read.line));
      REQUIRE(read.ready > asked[read.line]);
      REQUIRE(out.back.emplace(read.line, read.ready).second);
    }
    if (added == 2000 && model->finished()) break;
    if (now >= next_burst && burst == 0)
      burst = uint32_t(1 + random() % 90), next_burst = now + 200 + random() % 2000;
    for (; burst > 0 && added < 2000 && !model->full(); --burst, ++added) {
      const bool write = random() % 4 == 0;
      if (!write) asked[added * 128] = now;
      model->add(now, added * 128, 1, random() % (1u << 24) * 32, write);
    }
    REQUIRE(model->in_flight() <= params.queue);
    Cycle next = std::min(model->next_command(), burst > 0 ? kNever : next_burst);
    if (!model->returns().empty()) next = std::min(next, model->returns().front().ready);
    now = often ? now + 1 : std::max(now + 1, next);
    REQUIRE(now < 100'000'000);
  }
  REQUIRE(out.back.size() == asked.size());
  model->finish(200'000'000);
  const DramStats& s = model->stats();
  CHECK(s.reads.value() == asked.size());
  CHECK(s.reads.value() + s.writes.value() == 2000);
  CHECK(s.use.total() == model->clocks().clock_at(200'000'000));
  CHECK(s.use.total() == s.clocks.value());
  CHECK(s.busy_clocks.value() == 2000 * model->data_clocks());
  CHECK(s.use.count(DramUse::Data) == s.busy_clocks.value());
  out.busy = s.busy_clocks.value(), out.clocks = s.clocks.value(), out.active = s.active_clocks.value();
  return out;
}

// Returns the cycles at which `count` reads of one moment are back.
std::vector<Cycle> at_once(const char* settings, uint32_t count) {
  PolicyChoice<DramModel> choice("simple");
  Config config;
  config.add_text("test", settings);
  Diagnostics diagnostics;
  ConfigTable table = config.root(diagnostics);
  Registry<DramModel>::instance().entry("simple").read(table, &choice);
  REQUIRE_FALSE(diagnostics.has_errors());
  DramParams params;
  params.clock_mhz = 1000.0;
  stats::Group root(nullptr, "test");
  const auto model = choice.make({params, 256, 1000.0, &root});
  for (uint32_t i = 0; i < count; ++i) model->add(10, i * 128, 1, 0, false);
  while (model->next_command() != kNever) model->advance(model->next_command());
  std::vector<Cycle> out;
  for (; !model->returns().empty(); model->returns().pop()) out.push_back(model->returns().front().ready);
  return out;
}

}  // namespace

TEST_CASE(
    "every model of a memory channel answers each read once, counts each clock once and needs no extra "
    "calls") {
  REQUIRE(Registry<DramModel>::names() == std::vector<std::string>{"banked", "simple"});
  for (const std::string& name : Registry<DramModel>::names()) {
    INFO(name);
    const DramOutcome once = exercise(name, false);
    CHECK(once == exercise(name, true));
    CHECK(once == exercise(name, false));
  }
}

TEST_CASE("the simple model takes its latency and then one transfer after another") {
  // Each request has 4 clocks of data, and the model sees it at the next clock.
  CHECK(at_once("latency = 30.0\nefficiency = 1.0", 3) ==
        std::vector<Cycle>{11 + 30 + 4, 11 + 34 + 4, 11 + 38 + 4});
  CHECK(at_once("latency = 31.0\nefficiency = 1.0", 1) == std::vector<Cycle>{11 + 31 + 4});
  CHECK(at_once("latency = 30.0\nefficiency = 0.5", 3) ==
        std::vector<Cycle>{11 + 30 + 4, 11 + 38 + 4, 11 + 46 + 4});
}

TEST_CASE("the simple model meets an efficiency that is not a whole number of clocks in the long run") {
  const std::vector<Cycle> at = at_once("latency = 0.0\nefficiency = 0.9", 64);
  CHECK(double(at[63] - at[0]) == Approx(63 * 4 / 0.9).margin(1.0));
}
