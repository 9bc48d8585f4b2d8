// Tests the contract of L1Port, for the L1 cache and for the fixed-latency memory of the tests.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>
#include <map>
#include <random>
#include <utility>

#include "tests/support/catch.h"
#include "tests/support/fixed_latency_memory.h"
#include "tests/support/memory_rig.h"

using namespace glint;
using namespace glint::mem;

namespace {

struct Tried {
  Cycle at = 0;
  Client client = Client::Lsu;
};

// Sends a random mix of reads and writes, of which at most one per cycle is accepted. Refused requests are
// tried again unchanged.
class Mix {
 public:
  Cycle step(L1Port& port, Cycle now) {
    if (token_ == kRequests) return kNever;
    if (!pending_) {
      const auto sectors = uint8_t(1 + random_() % 15);
      request_ = {random_() % 64 * port.line_bytes(), sectors, random_() % 5 == 0, Traffic(random_() % 9),
                  token_};
      client_ = Client(random_() % 2);
      pending_ = true;
    }
    if (port.access(now, client_, request_)) {
      if (!request_.write) accepted[token_] = {now, client_};
      ++token_;
      pending_ = false;
    }
    return now + 1 + (random_() % 8 == 0 ? random_() % 300 : 0);
  }
  static constexpr Token kRequests = 4000;
  std::map<Token, Tried> accepted;

 private:
  std::mt19937 random_{3};
  Request request_;
  Client client_ = Client::Lsu;
  bool pending_ = false;
  Token token_ = 0;
};

void check_answers(const Mix& mix, const std::vector<Answered>& answers, Cycle least) {
  REQUIRE(answers.size() == mix.accepted.size());
  std::map<Token, int> seen;
  for (const Answered& a : answers) {
    const Tried& tried = mix.accepted.at(a.token);
    CHECK(a.client == tried.client);
    CHECK(a.at >= tried.at + least);
    CHECK(++seen[a.token] == 1);
  }
}

}  // namespace

TEST_CASE("the L1 cache gives every accepted read's token back once, to its client") {
  Params params;
  params.l1.size = 16 * 128;
  params.l1.mshr_entries = 4, params.l1.mshr_merges = 2, params.l1.miss_queue = 3;
  MemoryRig rig(params);
  Mix mix;
  rig.run([&](uint32_t, Cycle now) { return mix.step(rig.l1(), now); });
  check_answers(mix, rig.answers(), 0);
  CHECK(rig.l1().stats().refusals.total() > 0);
  CHECK(rig.l1().next_event(rig.now()) == kNever);
  rig.memory().check_drained();
}

TEST_CASE("the fixed-latency memory gives every accepted read's token back once, after exactly its latency") {
  FixedLatencyMemory memory(30, 1);
  Mix mix;
  std::vector<Answered> answers;
  Cycle wanted = 0;
  for (Cycle now = 0; wanted != kNever || memory.next_event(now) != kNever; ++now) {
    memory.tick(now);
    for (const Client client : {Client::Lsu, Client::RtUnit})
      while (const auto token = memory.pop(now, client)) answers.push_back({now, 0, client, *token});
    if (wanted <= now) wanted = mix.step(memory, now);
  }
  check_answers(mix, answers, 30);
  for (const Answered& a : answers) CHECK(a.at == mix.accepted.at(a.token).at + 30);
}

TEST_CASE("a refused request changes nothing: the same access later behaves as if it had never been tried") {
  const auto latency = [](bool try_first) {
    Params params;
    params.l1.mshr_entries = 1;
    MemoryRig rig(params);
    REQUIRE(rig.l1().access(0, Client::Lsu, {0, 1, false, Traffic::RtNode, 1}));
    if (try_first) REQUIRE_FALSE(rig.l1().access(1, Client::Lsu, {128, 1, false, Traffic::RtNode, 2}));
    rig.drain();
    const Cycle start = rig.now();
    REQUIRE(rig.l1().access(start, Client::Lsu, {128, 1, false, Traffic::RtNode, 2}));
    rig.drain();
    return std::pair{rig.answers().back().at - start, rig.l1().stats().reads.total()};
  };
  CHECK(latency(true) == latency(false));
}

TEST_CASE("an L1 cache that is not due has nothing to do: without these ticks, all answers come as before") {
  const auto credits = GENERATE(0u, 4u);
  const auto answers = [&](bool when_due) {
    Params params;
    params.l1.size = 16 * 128;
    params.l1.miss_queue = 3;
    params.noc.credits = credits;
    MemoryRig rig(params, 2);
    rig.set_step_every_cycle(true);
    rig.set_tick_when_due(when_due);
    std::array<Mix, 2> mix;
    rig.run([&](uint32_t core, Cycle now) { return mix[core].step(rig.l1(core), now); });
    return rig.answers();
  };
  CHECK(answers(true) == answers(false));
}
