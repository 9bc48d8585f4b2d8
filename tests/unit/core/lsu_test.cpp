// Tests the load-store unit: queues, rates and latency, between schedulers and a memory of fixed latency.
// SPDX-License-Identifier: Apache-2.0
#include "core/lsu.h"

#include <random>
#include <utility>

#include "tests/support/catch.h"
#include "tests/support/fixed_latency_memory.h"
#include "tests/unit/core/lsu_rig.h"

namespace glint::core {
namespace {

constexpr Cycle kMemoryLatency = 20;

// Takes nothing in odd cycles.
class HalfTimeMemory final : public mem::L1Port {
 public:
  HalfTimeMemory() { share_answers(memory_); }
  bool access(Cycle now, mem::Client client, const mem::Request& request) override {
    return now % 2 == 0 && memory_.access(now, client, request);
  }
  mem::Token take_answer(mem::Client client) override { return memory_.take_answer(client); }
  void tick(Cycle) override {}
  Cycle next_event(Cycle now) const override { return memory_.next_event(now); }
  uint32_t line_bytes() const override { return memory_.line_bytes(); }
  Cycle hit_latency() const override { return memory_.hit_latency(); }

 private:
  mem::FixedLatencyMemory memory_{kMemoryLatency};
};

// Gives the unit an access of `lines` whole lines.
void take(Lsu& lsu, uint32_t scheduler, Cycle now, uint32_t lines, bool write = false, bool texture = false,
          uint32_t bytes = 128) {
  REQUIRE(lsu.can_take(scheduler, texture));
  MemoryAccess& access = lsu.take(scheduler, now, texture);
  access.write = write;
  access.texture = texture;
  for (uint32_t i = 0; i < lines; ++i) access.lines.add(4096 + 128 * i, bytes, 0);
}

}  // namespace

TEST_CASE("an unloaded load takes the unit's latency and the memory's") {
  mem::FixedLatencyMemory memory(kMemoryLatency);
  Params params;
  params.units.lsu.latency = 12;
  Lsu lsu(params, memory);

  take(lsu, 0, 0, 1);

  CHECK(completions(lsu, 1) == std::vector<Cycle>{12 + kMemoryLatency});
}

TEST_CASE("a line of three sectors keeps the door for as many cycles as the unit needs for them") {
  for (const auto& [sectors, cycles] : {std::pair{1u, 3u}, {2u, 2u}, {3u, 1u}, {4u, 1u}}) {
    mem::FixedLatencyMemory memory(kMemoryLatency);
    Params params;
    params.lsu.sectors_per_cycle = sectors;
    Lsu lsu(params, memory);

    take(lsu, 0, 0, 2, false, false, 96);

    CHECK(completions(lsu, 1) == std::vector<Cycle>{12 + cycles + kMemoryLatency});
  }
}

TEST_CASE("an atomic on global memory keeps the door to the L1 for its own time") {
  // Returns the cycles between two accesses of one line each.
  const auto gap = [](mem::Traffic traffic, uint32_t interval) {
    mem::FixedLatencyMemory memory(kMemoryLatency);
    Params params;
    params.lsu.atomic_interval = interval;
    params.lsu.accept_interval = 1;
    Lsu lsu(params, memory);
    for (uint32_t scheduler = 0; scheduler < 2; ++scheduler) {
      MemoryAccess& access = lsu.take(scheduler, 0);
      access.write = true;
      access.traffic = traffic;
      access.lines.add(4096, 128, 0);
    }
    const std::vector<Cycle> ends = completions(lsu, 1);
    return ends.at(1) - ends.at(0);
  };
  const Cycle usual = gap(mem::Traffic::ShaderGlobal, 0);
  CHECK(gap(mem::Traffic::ShaderAtomic, 0) == usual);
  CHECK(gap(mem::Traffic::ShaderAtomic, 15) == 15);
  CHECK(gap(mem::Traffic::ShaderGlobal, 15) == usual);
}

TEST_CASE("accesses of one scheduler leave its queue at the interval of its address generation") {
  mem::FixedLatencyMemory memory(kMemoryLatency);
  Params params;
  params.units.lsu = {12, 4};
  Lsu lsu(params, memory);

  for (int i = 0; i < 3; ++i) take(lsu, 2, 0, 1);

  CHECK(completions(lsu, 1) == std::vector<Cycle>{32, 36, 40});
}

TEST_CASE("accesses of different schedulers are accepted at the unit's interval") {
  mem::FixedLatencyMemory memory(kMemoryLatency);
  Params params;
  params.lsu.accept_interval = 2;
  Lsu lsu(params, memory);

  for (uint32_t s = 0; s < 4; ++s) take(lsu, s, 0, 1);

  CHECK(completions(lsu, 1) == std::vector<Cycle>{32, 34, 36, 38});
}

TEST_CASE("lines leave at the sector rate") {
  mem::FixedLatencyMemory memory(kMemoryLatency);
  Params params;
  params.lsu.sectors_per_cycle = 2;
  Lsu whole(params, memory), single(params, memory);

  take(whole, 0, 0, 8);
  CHECK(completions(whole, 1) == std::vector<Cycle>{32 + 7 * 2});  // 4 sectors each take two cycles
  take(single, 0, 100, 8, false, false, 4);
  CHECK(completions(single, 101) == std::vector<Cycle>{132 + 7});  // one sector each: a line per cycle
}

TEST_CASE("a write ends when its last line has been taken, and is not answered") {
  mem::FixedLatencyMemory memory(kMemoryLatency);
  Lsu lsu(Params{}, memory);

  take(lsu, 0, 0, 3, true, false, 4);

  CHECK(completions(lsu, 1) == std::vector<Cycle>{12 + 2});
  REQUIRE(memory.log().size() == 3);
  CHECK(memory.log()[2].write);
}

TEST_CASE("a store leaves with the warp's store before it, if that waits and has the same few lines") {
  // Words 0 and 1 of each of `lines` lines, from warp slots `first` and `second`, `apart` cycles after
  // another.
  const auto requests = [](uint32_t lines, uint32_t first, uint32_t second, Cycle apart,
                           uint32_t offset = 4) {
    mem::FixedLatencyMemory memory(kMemoryLatency);
    Params params;
    params.lsu.merged_lines = 4;
    Lsu lsu(params, memory);
    const auto store = [&](uint32_t slot, Cycle now, uint32_t at) {
      MemoryAccess& access = lsu.take(0, now, false);
      access.slot = slot;
      access.write = true;
      access.traffic = mem::Traffic::ShaderGlobal;
      for (uint32_t i = 0; i < lines; ++i) access.lines.add(4096 + 128 * i + at, 4, 0);
    };
    store(first, 0, 0);
    for (Cycle now = 1; now < apart; ++now) {
      lsu.tick(now);
      for (uint32_t id : lsu.completed()) lsu.release(id);
    }
    store(second, apart, offset);
    completions(lsu, apart + 1);
    return memory.log();
  };
  const auto merged = requests(4, 3, 3, 2);
  REQUIRE(merged.size() == 4);
  CHECK(merged[0].words == 0b11);
  CHECK(merged[0].sectors == 1);
  CHECK(requests(4, 3, 3, 2, 36)[3].sectors == 0b11);
  CHECK(requests(5, 3, 3, 2).size() == 10);      // too many lines
  CHECK(requests(4, 3, 4, 2).size() == 8);       // another warp's
  CHECK(requests(4, 3, 3, 40).size() == 8);      // the first has left
  CHECK(requests(4, 3, 3, 2, 128).size() == 8);  // other lines
}

TEST_CASE("a texture access takes the texture unit's latency and does not hold up a load") {
  mem::FixedLatencyMemory memory(kMemoryLatency);
  Params params;
  params.units.tex.latency = 180;
  params.texture = {0, 0, false};
  Lsu lsu(params, memory);

  take(lsu, 0, 0, 1, false, true);
  take(lsu, 1, 0, 1);

  CHECK(completions(lsu, 1) == std::vector<Cycle>{34, 200});
}

TEST_CASE("a queue holds its capacity and no more") {
  mem::FixedLatencyMemory memory(kMemoryLatency);
  Params params;
  params.lsu.queue = 5;
  Lsu lsu(params, memory);

  for (int i = 0; i < 5; ++i) take(lsu, 1, 0, 1);
  CHECK_FALSE(lsu.can_take(1));
  CHECK(lsu.can_take(0));
  lsu.tick(1);  // the unit accepts one
  CHECK(lsu.can_take(1));
}

TEST_CASE("the table of accesses is a limit for all schedulers") {
  mem::FixedLatencyMemory memory(kMemoryLatency);
  Params params;
  params.lsu.accesses = 2;
  Lsu lsu(params, memory);

  take(lsu, 0, 0, 1);
  take(lsu, 1, 0, 1);
  CHECK_FALSE(lsu.can_take(2));
  completions(lsu, 1);
  CHECK(lsu.can_take(2));
}

TEST_CASE("a refused line is tried again in the next cycle") {
  HalfTimeMemory memory;
  Params params;
  params.units.lsu.latency = 13;  // the first try falls into an odd cycle
  Lsu lsu(params, memory);

  take(lsu, 0, 0, 1);
  for (Cycle now = 1; now <= 13; ++now) lsu.tick(now);
  CHECK(lsu.next_event(13) == 14);

  CHECK(completions(lsu, 14) == std::vector<Cycle>{14 + kMemoryLatency});
}

TEST_CASE("stepping from event to event completes accesses in the same cycles as stepping through") {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    std::vector<std::vector<Cycle>> runs;
    for (bool skip : {false, true}) {
      HalfTimeMemory memory;
      Lsu lsu(Params{}, memory);
      std::mt19937 random(seed);
      std::vector<std::pair<Cycle, uint32_t>> todo;  // cycle and access
      for (Cycle at = 0; todo.size() < 40; at += random() % 60) todo.push_back({at, random()});
      std::vector<Cycle> done;
      size_t next = 0;
      for (Cycle now = 0; next < todo.size() || !lsu.idle();) {
        lsu.tick(now);
        for (uint32_t id : lsu.completed()) done.push_back(now), lsu.release(id);
        for (; next < todo.size() && todo[next].first == now && lsu.can_take(todo[next].second % 4); ++next)
          take(lsu, todo[next].second % 4, now, 1 + todo[next].second % 7, todo[next].second & 8,
               todo[next].second & 16);
        if (next < todo.size() && todo[next].first == now)
          ++todo[next].first;  // there is no room, so it tries again a cycle later
        const Cycle event = std::min(lsu.next_event(now), std::max(now + 1, memory.next_event(now)));
        now = skip ? std::min(event, next < todo.size() ? todo[next].first : kNever) : now + 1;
      }
      runs.push_back(done);
    }
    CHECK(runs[0] == runs[1]);
  }
}

}  // namespace glint::core
