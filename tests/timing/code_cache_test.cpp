// Tests the cache behind instructions and constants, and the L0 with its stream buffer, to the cycle.
// SPDX-License-Identifier: Apache-2.0
#include "core/code_cache.h"

#include "core/constant_cache.h"
#include "core/instruction_fetch.h"
#include "tests/support/catch.h"
#include "tests/support/fixed_latency_memory.h"

namespace glint::core {
namespace {

using mem::Traffic;

constexpr Cycle kMemory = 20;

struct Rig {
  explicit Rig(CodeCacheParams params = {}, uint32_t accesses_per_cycle = ~0u)
      : memory(kMemory, accesses_per_cycle), cache(params, 64, memory, stats) {}
  // Steps from `from` on until something comes, and returns when.
  Cycle next_answer(Cycle from) {
    for (Cycle now = from;; ++now) {
      REQUIRE(now < from + 10'000);
      cache.tick(now);
      if (!cache.answers().empty()) return now;
    }
  }
  CodeStats stats{nullptr};
  mem::FixedLatencyMemory memory;
  CodeCache cache;
};

}  // namespace

TEST_CASE("a line that is there comes after the latency, one that is not after the memory's as well") {
  for (uint32_t latency : {2u, 5u, 78u}) {
    CAPTURE(latency);
    Rig rig({.latency = latency});
    rig.cache.ask(3, 1024, Traffic::Instruction, 10);
    CHECK(rig.next_answer(11) == 10 + latency + kMemory);
    CHECK(rig.cache.answers()[0].client == 3);
    CHECK(rig.cache.answers()[0].line == 1024);
    CHECK(rig.cache.idle());
    rig.cache.ask(1, 1024, Traffic::Instruction, 500);
    CHECK(rig.next_answer(501) == 500 + latency);
    REQUIRE(rig.memory.log().size() == 1);
    CHECK(rig.memory.log()[0].sectors == 0xf);
    CHECK(rig.memory.log()[0].traffic == Traffic::Instruction);
  }
}

TEST_CASE("one line is looked up a cycle") {
  Rig rig;
  rig.cache.ask(0, 0, Traffic::Instruction, 0);
  rig.next_answer(1);
  for (uint32_t client = 0; client < 3; ++client) rig.cache.ask(client, 0, Traffic::Instruction, 200);
  CHECK(rig.next_answer(201) == 278);
  CHECK(rig.next_answer(279) == 279);
  CHECK(rig.next_answer(280) == 280);
}

TEST_CASE("a line on its way is fetched once and comes to all who wait for it") {
  Rig rig;
  rig.cache.ask(0, 0, Traffic::Instruction, 0);
  rig.cache.ask(1, 0, Traffic::Instruction, 0);
  CHECK(rig.next_answer(1) == 98);
  CHECK(rig.cache.answers().size() == 2);
  CHECK(rig.memory.log().size() == 1);
  CHECK(rig.stats.cache_misses.value() == 2);
}

TEST_CASE("the least recently used line gives way") {
  Rig rig({.size = 1024, .ways = 0, .latency = 2});  // eight lines
  Cycle now = 0;
  const auto misses = [&](Address line) {
    const uint64_t before = rig.stats.cache_misses.value();
    rig.cache.ask(0, line, Traffic::Instruction, now);
    now = rig.next_answer(now + 1) + 1;
    return rig.stats.cache_misses.value() != before;
  };
  for (Address line = 0; line < 8 * 128; line += 128) CHECK(misses(line));
  CHECK_FALSE(misses(0));
  CHECK(misses(8 * 128));
  CHECK_FALSE(misses(0));
  CHECK(misses(128));
}

TEST_CASE("a refused line is tried again, and the next event says when") {
  Rig rig({.latency = 10}, 1);
  rig.cache.ask(0, 0, Traffic::Constant, 0);
  CHECK(rig.cache.next_event(0) == 1);
  rig.cache.tick(1);
  CHECK(rig.cache.next_event(1) == 5);
  rig.memory.access(5, mem::Client::Lsu, {4096, 1, false, Traffic::ShaderGlobal, 0});  // takes the cycle
  rig.cache.tick(5);
  CHECK(rig.memory.refused() == 1);
  CHECK(rig.cache.next_event(5) == 6);
  CHECK(rig.next_answer(6) == 1 + 10 + kMemory);
}

namespace {

struct FetchRig : Rig {
  explicit FetchRig(FetchParams params, size_t instructions = 1000)
      : Rig({.latency = 10}), fetch(params, 2, 0, instructions, cache, stats) {}
  // Returns the cycle in which a warp of scheduler 0 that comes to `line` in cycle `now` can go on.
  Cycle come_to(uint32_t line, Cycle now) {
    if (fetch.come_to(0, line, now)) return now;
    for (Cycle at = now + 1;; ++at) {
      REQUIRE(at < now + 10'000);
      if (step(at, line)) return at;
    }
  }
  bool step(Cycle at, uint32_t line = InstructionFetch::kNone) {
    bool came = false;
    cache.tick(at);
    for (const auto& answer : cache.answers()) came |= fetch.arrive(answer.client, answer.line) == line;
    return came && line != InstructionFetch::kNone;
  }
  InstructionFetch fetch;
};

}  // namespace

TEST_CASE("a line of instructions is eight of them, and is there once it has come") {
  FetchRig rig({.prefetch = 0});
  CHECK(rig.fetch.line_of(7) == 0);
  CHECK(rig.fetch.line_of(8) == 1);
  CHECK(rig.come_to(0, 100) == 100 + 10 + kMemory);
  CHECK(rig.come_to(0, 200) == 200);
  CHECK(rig.come_to(1, 300) == 300 + 10 + kMemory);
  CHECK(rig.stats.misses.value() == 2);
}

TEST_CASE("an L0 of one line forgets the one before, which the cache behind still has") {
  FetchRig rig({.size = 128, .ways = 1, .prefetch = 0});
  rig.come_to(0, 0);
  rig.come_to(1, 100);
  CHECK(rig.come_to(0, 200) == 200 + 10);
}

TEST_CASE("the stream buffer has the next lines, and as many again after each") {
  FetchRig rig({.prefetch = 2});
  CHECK(rig.come_to(0, 0) == 10 + kMemory);
  CHECK(rig.stats.prefetches.value() == 2);
  for (Cycle at = 31; at < 100; ++at) rig.step(at);
  CHECK(rig.come_to(1, 100) == 100);  // was fetched ahead
  CHECK(rig.stats.prefetches.value() == 3);
  CHECK(rig.come_to(3, 100) == 100 + 10 + kMemory);  // on its way since cycle 100
  CHECK(rig.stats.prefetch_hits.value() == 1);
  CHECK(rig.stats.misses.value() == 2);
}

TEST_CASE("a jump starts another stream, which ends with the code") {
  FetchRig rig({.prefetch = 4}, 96);  // twelve lines
  rig.come_to(0, 0);
  for (Cycle at = 31; at < 100; ++at) rig.step(at);
  CHECK(rig.come_to(9, 100) == 100 + 10 + kMemory);
  CHECK(rig.stats.prefetches.value() == 4 + 2);  // 10 and 11
  for (Cycle at = 131; at < 200; ++at) rig.step(at);
  CHECK(rig.come_to(2, 200) == 210);  // of the stream given up: only the cache behind has it
}

TEST_CASE("a constant line misses once, and a warp waits for all of its lines") {
  Rig rig({.latency = 10});
  ConstantCache constants({.size = 128, .ways = 0, .line = 64}, 4096, 1 << 16, 8, rig.cache, rig.stats);
  isa::Access access{};
  access.address[1] = 64;
  access.address[2] = 640;  // another line of the cache behind
  CHECK_FALSE(constants.look_up(5, access, 0b111, 0, 0));
  std::vector<std::pair<Cycle, uint32_t>> served;
  for (Cycle now = 1; now < 100; ++now) {
    rig.cache.tick(now);
    for (const auto& answer : rig.cache.answers())
      constants.arrive(answer.line, [&](uint32_t slot) { served.push_back({now, slot}); });
  }
  CHECK(served == std::vector<std::pair<Cycle, uint32_t>>{
                      {10 + kMemory + 1, 5}});  // the second line is looked up a cycle later
  CHECK(rig.stats.constant_misses.value() == 3);
  CHECK(rig.memory.log().size() == 2);
  CHECK(constants.look_up(5, access, 0b100, 0, 200));
  CHECK_FALSE(constants.look_up(5, access, 0b111, 0, 300));  // three lines do not fit two
}

}  // namespace glint::core
