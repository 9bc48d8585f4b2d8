// Tests the promises of IssueScheduler for every registered policy, and what each policy is for.
// SPDX-License-Identifier: Apache-2.0
#include "core/issue_scheduler.h"

#include <algorithm>
#include <random>
#include <vector>

#include "core/params.h"
#include "tests/support/catch.h"

namespace glint::core {
namespace {

std::unique_ptr<IssueScheduler> make(const std::string& name, uint32_t num_warps) {
  return PolicyChoice<IssueScheduler>(name.c_str()).make({num_warps});
}

std::vector<uint64_t> ages(uint32_t n) {  // not in the order of the slots
  std::vector<uint64_t> out;
  for (uint32_t i = 0; i < n; ++i) out.push_back(uint64_t{1000} - i * 7 % 31);
  return out;
}

}  // namespace

TEST_CASE("every issue policy picks a ready warp, and the same one for the same views") {
  for (const std::string& name : Registry<IssueScheduler>::names())
    for (uint32_t n : {1u, 2u, 8u, 16u, 64u}) {
      CAPTURE(name, n);
      const auto one = make(name, n), two = make(name, n);
      const std::vector<uint64_t> age = ages(n);
      std::mt19937_64 random(n);
      const uint64_t all = n == 64 ? ~uint64_t{0} : (uint64_t{1} << n) - 1;
      for (Cycle now = 0; now < 2000; ++now) {
        const uint64_t ready = random() & random() & all;
        if (!ready) continue;
        const RtView rt{random() & all, random() % 2 == 0};
        const uint32_t pick = one->pick({ready, age, now, rt});
        REQUIRE(pick < n);
        REQUIRE((ready >> pick & 1) == 1);
        REQUIRE(two->pick({ready, age, now, rt}) == pick);
      }
    }
}

TEST_CASE("every issue policy reaches every warp when picked warps have to wait") {
  for (const std::string& name : Registry<IssueScheduler>::names()) {
    CAPTURE(name);
    constexpr uint32_t kWarps = 16;
    const auto policy = make(name, kWarps);
    const std::vector<uint64_t> age = ages(kWarps);
    for (const RtView& rt : {RtView{}, RtView{0x00f0, false}, RtView{0x0f03, true}}) {
      uint64_t ready = 0xffff;
      for (Cycle now = 0; ready;
           ++now) {  // a picked warp never becomes ready again, so each pick is a new one
        REQUIRE(now < kWarps);
        ready &= ~(uint64_t{1} << policy->pick({ready, age, now, rt}));
      }
    }
  }
}

TEST_CASE("every issue policy that holds warps back lets each of them go on when no other warp issues") {
  int num_holding = 0;
  for (const std::string& name : Registry<IssueScheduler>::names()) {
    CAPTURE(name);
    constexpr uint32_t kWarps = 8;
    const auto policy = make(name, kWarps);
    if (!policy->holds_back()) continue;
    ++num_holding;
    const std::vector<uint64_t> age = ages(kWarps);
    std::mt19937_64 random(5);
    L1Listener* const listener = policy->l1_listener();
    if (listener) listener->start(16);
    bool has_held = false;
    Cycle now = 0;
    const auto view = [&](uint64_t ready) {
      return IssueView{ready, age, now, {}, 0xff, 0x7f};  // warp 7 is at no memory instruction
    };
    for (; now < 5000; ++now) {
      const auto line = Address{random() % 64 * 128};
      if (listener && random() % 4 == 0) {
        listener->missed(uint32_t(random() % kWarps), line);
        listener->replaced(uint32_t(random() % 16), uint32_t(random() % kWarps),
                           Address{random() % 64 * 128});
      }
      const uint64_t ready = random() & 0xff;
      if (!ready) continue;
      const uint64_t allowed = policy->allowed(view(ready));
      REQUIRE((allowed & ~ready) == 0);
      REQUIRE((allowed & 0x80) == (ready & 0x80));
      has_held |= allowed != ready;
      if (allowed) policy->pick(view(allowed));
    }
    CHECK(has_held);
    for (now += 1'000'000; uint64_t warp : {1, 2, 4, 8, 16, 32, 64, 128})
      CHECK(policy->allowed(view(warp)) == warp);
  }
  CHECK(num_holding == 1);
}

TEST_CASE("ccws holds loads of the youngest back when another warp misses a line that it has lost") {
  const auto ccws = make("ccws", 4);
  L1Listener& l1 = *ccws->l1_listener();
  l1.start(2);
  const std::vector<uint64_t> age = {30, 10, 20, 40};
  const auto allowed = [&](Cycle now, uint64_t at_memory = 0b1111) {
    return ccws->allowed({0b1111, age, now, {}, 0b1111, at_memory});
  };
  for (Cycle now = 0; now < 100; ++now) ccws->pick({0b1111, age, now});
  l1.replaced(0, 1, {});
  l1.missed(1, 0);           // It was never lost.
  l1.replaced(1, 0, {});     // Warp 0 asks for a line in the other place,
  l1.replaced(0, {}, 0x80);  // and the RT unit takes the place of warp 1's line 0x80.
  l1.missed(0, 0x80);        // Warp 0 has not lost that line.
  CHECK(allowed(100) == 0b1111);
  // One lost line for 100 instructions gives 1 * 8 * (4 * 400) / 100 = 128, which is less than the base.
  l1.missed(1, 0x80);
  CHECK(allowed(100) == 0b1111);
  // Warp 1 loses and misses nine more lines: 10 * 8 * 1600 / 100 = 1280. With it at the bottom, warps 2 and 0
  // begin at 1280 and 1680. The sum of the base scores is 1600, so that warps 0 and 3 are above it.
  for (Address line = 0x80; line < 0x80 * 10; line += 0x80) {
    l1.replaced(0, 1, {});
    l1.replaced(0, {}, line);
    l1.missed(1, line);
    l1.missed(1, line);  // It is remembered once.
  }
  CHECK(allowed(101) == 0b0110);
  CHECK(allowed(101, 0b0101) == 0b1110);  // Warp 3 is not at memory.
  // The score falls by one in a cycle. It is 1199 at cycle 182, when warp 0 begins at 1599, and 799 at cycle
  // 582, when warp 3 does.
  CHECK(allowed(181) == 0b0110);
  CHECK(allowed(182) == 0b0111);
  CHECK(allowed(581) == 0b0111);
  CHECK(allowed(582) == 0b1111);
}

TEST_CASE("gto stays with its warp while that is ready, then takes the oldest") {
  const auto gto = make("gto", 4);
  const std::vector<uint64_t> age = {30, 10, 20, 40};

  CHECK(gto->pick({0b1001, age, 0}) == 0);  // oldest of 0 and 3
  CHECK(gto->pick({0b1111, age, 1}) == 0);  // greedy, although 1 is older
  CHECK(gto->pick({0b1110, age, 2}) == 1);  // then the oldest
  CHECK(gto->pick({0b1101, age, 3}) == 2);
  CHECK(gto->pick({0b1111, age, 4}) == 2);
}

TEST_CASE("gto is not greedy for a new warp in the old one's place") {
  const auto gto = make("gto", 2);
  CHECK(gto->pick({0b01, std::vector<uint64_t>{0, 1}, 0}) == 0);
  CHECK(gto->pick({0b11, std::vector<uint64_t>{2, 1}, 1}) == 1);
}

TEST_CASE("cggty stays with its warp while that is ready, then takes the youngest") {
  const auto cggty = make("cggty", 4);
  const std::vector<uint64_t> age = {30, 10, 20, 40};

  CHECK(cggty->pick({0b0111, age, 0}) == 0);  // youngest of 0, 1 and 2
  CHECK(cggty->pick({0b1111, age, 1}) == 0);  // greedy, although 3 is younger
  CHECK(cggty->pick({0b1110, age, 2}) == 3);  // then the youngest
  CHECK(cggty->pick({0b0110, age, 3}) == 2);
  CHECK(cggty->pick({0b1111, age, 4}) == 2);
}

TEST_CASE("cggty is not greedy for a new warp in the old one's place") {
  const auto cggty = make("cggty", 2);
  CHECK(cggty->pick({0b01, std::vector<uint64_t>{0, 1}, 0}) == 0);
  CHECK(cggty->pick({0b11, std::vector<uint64_t>{2, 3}, 1}) == 1);
}

TEST_CASE("lrr goes round") {
  const auto lrr = make("lrr", 4);
  const std::vector<uint64_t> age = {30, 10, 20, 40};

  for (uint32_t i = 0; i < 8; ++i) CHECK(lrr->pick({0b1111, age, i}) == i % 4);
  CHECK(lrr->pick({0b1101, age, 8}) == 0);
  CHECK(lrr->pick({0b1101, age, 9}) == 2);
}

TEST_CASE("oldest never stays with a younger warp") {
  const auto oldest = make("oldest", 4);
  const std::vector<uint64_t> age = {30, 10, 20, 40};

  CHECK(oldest->pick({0b1001, age, 0}) == 0);
  CHECK(oldest->pick({0b1111, age, 1}) == 1);
}

TEST_CASE("rt_aware fills an RT unit with room, and is greedy then oldest for one without") {
  const auto aware = make("rt_aware", 4);
  CHECK(aware->needs_rt());
  CHECK_FALSE(make("gto", 4)->needs_rt());
  const std::vector<uint64_t> age = {30, 10, 20, 40};
  const RtView room{0b1001, true}, full{0b1001, false};

  CHECK(aware->pick({0b1111, age, 0, room}) == 0);  // the oldest of those at rays, 0 and 3
  CHECK(aware->pick({0b0111, age, 1, full}) == 0);  // the same again
  CHECK(aware->pick({0b0110, age, 2, full}) == 1);  // the oldest
  CHECK(aware->pick({0b0110, age, 3, full}) == 1);
  CHECK(aware->pick({0b0100, age, 4, full}) == 2);
  // Warp 1 has issued two instructions and warp 2 one. Warp 0 has given its rays, and 3 has issued nothing.
  CHECK(aware->pick({0b1110, age, 5, {0, true}}) == 1);
  CHECK(aware->pick({0b1100, age, 6, {0, true}}) == 2);
  // A new warp in the place of warp 1 has issued nothing yet.
  CHECK(aware->pick({0b1110, std::vector<uint64_t>{30, 50, 20, 40}, 7, {0, true}}) == 2);
}

TEST_CASE("the default issue policy is one of several that are registered") {
  const std::vector<std::string> names = Registry<IssueScheduler>::names();
  CHECK(names.size() >= 3);
  CHECK(std::count(names.begin(), names.end(), Params{}.issue.name) == 1);
}

}  // namespace glint::core
