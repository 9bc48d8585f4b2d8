// Tests the contract of Replacement for every registered policy, and the order of victims of each.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/replacement.h"

#include <algorithm>
#include <random>
#include <set>
#include <vector>

#include "base/registry.h"
#include "memsys/cache/tag_array.h"
#include "memsys/replacement/set_duel.h"
#include "tests/support/catch.h"
#include "tests/support/memory_rig.h"

using namespace glint;
using namespace glint::mem;

namespace {

PolicyChoice<Replacement> chosen(const std::string& name, const std::string& params = {}) {
  PolicyChoice<Replacement> choice(name.c_str());
  Config config;
  config.add_text("test", params);
  Diagnostics diagnostics;
  ConfigTable table = config.root(diagnostics);
  Registry<Replacement>::instance().entry(name).read(table, &choice);
  REQUIRE_FALSE(diagnostics.has_errors());
  return choice;
}

// Holds the lines of one cache, and the policy under test.
struct Cache {
  Cache(const std::string& name, uint32_t sets, uint32_t num_ways)
      : ways(num_ways), lines(size_t{sets} * num_ways), policy(chosen(name).make({sets, num_ways})) {}
  uint32_t victim(uint32_t set) const { return policy->victim(set, lines); }

  const uint32_t ways;
  std::vector<CacheLine> lines;
  std::unique_ptr<Replacement> policy;
};

// Makes one random event in the set. Returns the slot that it chose, or kNone.
uint32_t random_event(Cache& cache, uint32_t set, std::mt19937& random) {
  const uint32_t slot = set * cache.ways + uint32_t(random() % cache.ways);
  CacheLine& line = cache.lines[slot];
  switch (random() % 5) {
    case 0:
      if (line.used()) cache.policy->touched(slot);
      return Replacement::kNone;
    case 1:
      line.held = line.used() && !line.held;
      if (!line.used()) cache.policy->emptied(slot);
      return Replacement::kNone;
    case 2:
      if (line.used() && !line.held) line.valid = line.dirty = 0, cache.policy->emptied(slot);
      return Replacement::kNone;
    default:
      break;
  }
  const uint32_t victim = cache.victim(set);
  if (victim == Replacement::kNone) return victim;
  cache.lines[victim].valid = 1;
  cache.policy->filled(victim);
  return victim;
}

// Returns the victims of a set under random events, and checks each of them.
std::vector<uint32_t> exercise(Cache& cache, uint32_t set, uint32_t seed,
                               const std::function<void()>& other) {
  std::mt19937 random(seed);
  std::vector<uint32_t> victims;
  const auto first = cache.lines.begin() + ptrdiff_t(set * cache.ways);
  for (int i = 0; i < 2000; ++i) {
    other();
    const bool all_held =
        std::all_of(first, first + cache.ways, [](const CacheLine& line) { return line.held; });
    const uint32_t victim = cache.victim(set);
    REQUIRE((victim == Replacement::kNone) == all_held);
    REQUIRE(cache.victim(set) == victim);
    if (!all_held) {
      REQUIRE(victim / cache.ways == set);
      REQUIRE_FALSE(cache.lines[victim].held);
    }
    victims.push_back(random_event(cache, set, random));
  }
  return victims;
}

// Returns the lines that make way when `lines` are read one after another in a cache of one set.
std::vector<Address> victims(const PolicyChoice<Replacement>& policy, uint32_t ways,
                             const std::vector<Address>& lines) {
  TagArray tags({1, ways, 128}, policy);
  std::vector<Address> out;
  for (const Address number : lines) {
    const Address line = number * 128;
    if (const uint32_t slot = tags.find(line); slot != TagArray::kNone) {
      tags.touch(slot);
      continue;
    }
    if (tags.victim(line).used()) out.push_back(tags.victim(line).address() / 128);
    tags.insert(line).valid = 1;
  }
  return out;
}

using Lines = std::vector<Address>;

}  // namespace

TEST_CASE("every replacement policy names a line of the set that is not held, or none when all are held") {
  REQUIRE(Registry<Replacement>::names() ==
          std::vector<std::string>{"drrip", "fifo", "lru", "plru", "random", "srrip"});
  for (const std::string& name : Registry<Replacement>::names())
    for (const uint32_t ways : {1u, 2u, 6u, 16u, 33u}) {
      CAPTURE(name, ways);
      Cache cache(name, 4, ways);
      exercise(cache, 2, 7, [] {});
    }
}

TEST_CASE("with every replacement policy, a set's victims depend on nothing but the events of the cache") {
  for (const std::string& name : Registry<Replacement>::names()) {
    CAPTURE(name);
    const auto among_others = [&](Cache& cache) {
      std::mt19937 random(3);
      return exercise(cache, 4, 11, [&] { random_event(cache, random() % 2 ? 0 : 3, random); });
    };
    Cache alone(name, 5, 6), again(name, 5, 6), crowded(name, 5, 6), crowded_again(name, 5, 6);
    const std::vector<uint32_t> plain = exercise(alone, 4, 11, [] {});
    CHECK(plain == exercise(again, 4, 11, [] {}));
    CHECK(plain != exercise(again, 1, 12, [] {}));
    const std::vector<uint32_t> among = among_others(crowded);
    CHECK(among == among_others(crowded_again));
    // Only a policy whose sets share state chooses otherwise because of another set. In its duel, sets 0 and
    // 2 lead for one side, 1 and 3 for the other, and set 4 follows.
    CHECK((among == plain) == (name != "drrip"));
  }
}

TEST_CASE("with every replacement policy, a cache is filled before any line makes way") {
  for (const std::string& name : Registry<Replacement>::names())
    for (const uint32_t ways : {1u, 5u, 8u, 256u}) {
      CAPTURE(name, ways);
      Lines lines;
      for (Address line = 0; line < ways; ++line) lines.push_back(line);
      CHECK(victims(chosen(name), ways, lines).empty());
      lines.push_back(ways);
      CHECK(victims(chosen(name), ways, lines).size() == 1);
    }
}

TEST_CASE("with every replacement policy, windows and stepping change no answer of the memory system") {
  for (const std::string& name : Registry<Replacement>::names()) {
    CAPTURE(name);
    const auto run = [&](Cycle window, bool step) {
      Params params = bare();
      params.l1.size = 8 * 128, params.l2.slice_size = 16 * 128, params.l2.ways = 4;
      params.l1.replacement = params.l2.replacement = chosen(name);
      MemoryRig rig(params, 2);
      if (window) rig.set_window(window);
      rig.set_step_every_cycle(step);
      std::vector<std::mt19937> random{std::mt19937(1), std::mt19937(2)};
      std::vector<uint32_t> left{400, 400};
      rig.run([&](uint32_t core, Cycle now) {
        const bool write = random[core]() % 8 == 0;
        const Address line = random[core]() % (random[core]() % 4 ? 12 : 60) * 128;
        const Request request{line, 1, write, write ? Traffic::ShaderLocal : Traffic::RtNode, left[core]};
        if (rig.l1(core).access(now, Client::Lsu, request)) --left[core];
        return left[core] ? now + 1 : kNever;
      });
      rig.memory().check_drained();
      return rig.answers();
    };
    const std::vector<Answered> plain = run(0, false);
    CHECK(plain.size() > 600);
    CHECK(plain == run(1, false));
    CHECK(plain == run(0, true));
  }
}

TEST_CASE("lru replaces the line that was used longest ago, fifo the line that came first") {
  const Lines reads{0, 1, 2, 3, 0, 1, 4, 5, 6, 0, 7};
  CHECK(victims(chosen("lru"), 4, reads) == Lines{2, 3, 0, 1, 4});
  CHECK(victims(chosen("fifo"), 4, reads) == Lines{0, 1, 2, 3, 4});
}

TEST_CASE("lru keeps the same order in a set of any size") {
  std::mt19937 random(5);
  for (const uint32_t ways : {1u, 2u, 16u, 32u, 33u, 100u}) {
    CAPTURE(ways);
    TagArray tags({1, ways, 128}, chosen("lru"));
    Lines order;  // the lines that are present, newest first
    for (int i = 0; i < 2000; ++i) {
      const Address line = random() % (2 * ways) * 128;
      const uint32_t slot = tags.find(line);
      const auto found = std::find(order.begin(), order.end(), line);
      REQUIRE((slot == TagArray::kNone) == (found == order.end()));
      if (found != order.end()) {
        tags.touch(slot);
        order.erase(found);
      } else {
        if (order.size() == ways) {
          REQUIRE(tags.victim(line).address() == order.back());
          order.pop_back();
        }
        tags.insert(line).valid = 1;
      }
      order.insert(order.begin(), line);
    }
  }
}

TEST_CASE("plru follows its bits away from the lines used last, and past ways that do not exist") {
  // Ways are filled in order. After 0 1 2 3 the root names the lower half, and both halves name their lower
  // way.
  CHECK(victims(chosen("plru"), 4, {0, 1, 2, 3, 4, 5}) == Lines{0, 2});
  // Line 0 turns the root to the upper half, whose lower way is 2. True LRU would take 1.
  CHECK(victims(chosen("plru"), 4, {0, 1, 2, 3, 0, 4}) == Lines{2});
  CHECK(victims(chosen("plru"), 4, {0, 1, 2, 3, 0, 2, 4, 5, 6}) == Lines{1, 3, 0});
  // The tree of three ways has a fourth leaf, which is passed over: the upper half always gives way 2.
  CHECK(victims(chosen("plru"), 3, {0, 1, 2, 3, 4, 5, 6}) == Lines{0, 2, 1, 4});
}

TEST_CASE("srrip keeps a line that was used again while lines that were not used again make way") {
  // New lines get the value 2. Lines 0 and 1 are used again and get 0. Then the set ages until line 2 has 3.
  CHECK(victims(chosen("srrip"), 4, {0, 1, 2, 3, 0, 1, 4, 5, 6, 7}) == Lines{2, 3, 4, 5});
  // A line that was used once grows old: two fills bring line 0 from value 0 to 2. Of lines with equal
  // values, the one in the lower slot makes way.
  CHECK(victims(chosen("srrip"), 2, {0, 1, 0, 2, 3, 4}) == Lines{1, 2, 0});
  // With one bit the policy is "not recently used": a new line gets 0, like a line that was used again.
  CHECK(victims(chosen("srrip", "bits = 1\n"), 2, {0, 1, 0, 2, 3, 4}) == Lines{0, 1, 2});
}

TEST_CASE("srrip takes a line that lost its sectors first, and ages no other line for it") {
  TagArray tags({1, 3, 128}, chosen("srrip"));
  for (const Address line : {0, 128, 256}) tags.insert(line).valid = 1;
  tags.touch(tags.find(0));
  tags.drop(tags.find(0), 1);
  CHECK_FALSE(tags.victim(384).used());
  tags.insert(384).valid = 1;  // has the value 2, like 128 and 256
  tags.touch(tags.find(128));
  CHECK(tags.victim(512).address() == 384);  // is in the lower slot of two lines with the value 2
}

TEST_CASE("drrip with one set is srrip, and a cache of lines that come round keeps some of them by brrip") {
  const Lines reads{0, 1, 2, 3, 0, 1, 4, 5, 6, 7, 2, 3, 0};
  CHECK(victims(chosen("drrip"), 4, reads) == victims(chosen("srrip"), 4, reads));
  // 80 sets of 4 ways read 480 lines in turn. SRRIP has left each before it comes again.
  const auto hits = [&](const std::string& name, const std::string& params = {}) {
    TagArray tags({80, 4, 128}, chosen(name, params));
    int count = 0;
    for (int round = 0; round < 40; ++round)
      for (Address line = 0; line < 480 * 128; line += 128) {
        const uint32_t slot = tags.find(line);
        if (slot == TagArray::kNone)
          tags.insert(line).valid = 1;
        else
          tags.touch(slot), ++count;
      }
    return count;
  };
  CHECK(hits("lru") < 2 * hits("drrip"));
  CHECK(hits("srrip") < hits("drrip"));
  CHECK(hits("drrip", "rare = 1\n") == hits("srrip"));  // Then the second policy is the first.
}

TEST_CASE(
    "a set duel has as many leaders of either policy as asked for, and the others follow the better one") {
  for (const uint32_t sets : {1u, 2u, 3u, 4u, 64u, 100u, 1024u}) {
    CAPTURE(sets);
    SetDuel duel(sets, 32, 4);
    const auto seconds = [&] {
      uint32_t count = 0;
      for (uint32_t set = 0; set < sets; ++set) count += duel.uses_second(set);
      return count;
    };
    const uint32_t leaders = std::min(32u, sets / 2);
    CHECK(seconds() == leaders);  // At first the others follow the first policy.
    // Each set misses once, and those of the two policies weigh each other out.
    for (uint32_t set = 0; set < sets; ++set) duel.missed(set);
    CHECK(seconds() == leaders);
    for (uint32_t i = 0; i < 20; ++i)
      for (uint32_t set = 0; set < sets; ++set)
        if (!duel.uses_second(set)) duel.missed(set);
    CHECK(seconds() == (leaders ? sets - leaders : 0));
    for (uint32_t i = 0; i < 20; ++i)
      for (uint32_t set = 0; set < sets; ++set)
        if (duel.uses_second(set)) duel.missed(set);
    CHECK(seconds() == leaders);
  }
}

TEST_CASE("random draws every way about as often, another seed draws another sequence") {
  Lines reads;
  for (Address line = 0; line < 4008; ++line) reads.push_back(line);
  const Lines out = victims(chosen("random"), 8, reads);
  CHECK(out == victims(chosen("random", "seed = 1\n"), 8, reads));
  CHECK(out != victims(chosen("random", "seed = 2\n"), 8, reads));
  // The age of a victim is geometric with a mean of 8 fills, so one line in eight stays for more than 15
  // fills.
  size_t old = 0;
  for (size_t i = 0; i < out.size(); ++i) old += i + 8 - out[i] > 15;
  CHECK(old > out.size() / 10);
  CHECK(old < out.size() / 6);
}
