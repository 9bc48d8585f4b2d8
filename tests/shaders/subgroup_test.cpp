// Tests subgroup operations against plainly written sums over the lanes that take part.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <limits>

#include "tests/shaders/compute_lab.h"
#include "tests/support/catch.h"

namespace glint::test::subgroup_test {
namespace {

constexpr uint32_t kThreads = 64, kWords = 56;

uint32_t bits(float x) {
  return std::bit_cast<uint32_t>(x);
}

Words inputs() {
  Words words;
  for (uint32_t state = 5; words.size() < kThreads;) {
    state = state * 747796405u + 2891336453u;
    words.push_back(state >> 24);
  }
  return words;
}

// Describes one warp, of whose lanes `active` execute.
struct Warp {
  const uint32_t* x;
  uint32_t active;

  bool has(uint32_t lane) const { return (active >> lane & 1) != 0; }
  // Combines f(x) over the executing lanes of `mask`, in their order.
  template <class T, class F, class Op>
  T over(uint32_t mask, T start, F f, Op op) const {
    T sum = start;
    for (uint32_t lane = 0; lane < 32; ++lane)
      if (has(lane) && (mask >> lane & 1) != 0) sum = T(op(sum, f(x[lane])));
    return sum;
  }
  template <class F>
  uint32_t ballot(F f) const {
    uint32_t lanes = 0;
    for (uint32_t lane = 0; lane < 32; ++lane)
      if (has(lane) && f(x[lane])) lanes |= 1u << lane;
    return lanes;
  }
};

// Applies functions to the same words that the shader's work() stores.
class Reference {
 public:
  Reference(const Warp& warp, uint32_t lane) : warp_(warp), lane_(lane), x_(warp.x[lane]) {}

  Words words() {
    votes();
    reductions();
    scans();
    clusters();
    return row_;
  }

 private:
  static constexpr uint32_t kAll = 0xffff'ffff;
  static uint32_t same(uint32_t x) { return x; }
  static uint32_t odd(uint32_t x) { return x | 1; }
  static float real(uint32_t x) { return float(x); }
  static constexpr auto kAdd = [](auto a, auto b) { return a + b; };
  static constexpr auto kMul = [](auto a, auto b) { return a * b; };
  static constexpr auto kMin = [](auto a, auto b) { return std::min(a, b); };
  static constexpr auto kMax = [](auto a, auto b) { return std::max(a, b); };
  uint32_t below() const { return (1u << lane_) - 1; }
  uint32_t up_to() const { return below() | 1u << lane_; }
  void put(uint32_t word) { row_.push_back(word); }
  void put64(uint64_t word) { put(uint32_t(word)), put(uint32_t(word >> 32)); }

  void votes() {
    const uint32_t first = uint32_t(std::countr_zero(warp_.active));
    put(lane_ == first);
    put(warp_.ballot([](uint32_t x) { return x > 5; }) == warp_.active);
    put(warp_.ballot([](uint32_t x) { return x > 250; }) != 0);
    put(1);
    const uint32_t odds = warp_.ballot([](uint32_t x) { return (x & 1) == 1; });
    put(odds), put(0), put(odds >> lane_ & 1), put(odds >> (x_ & 31) & 1);
    put(uint32_t(std::popcount(odds) | std::popcount(odds & up_to()) << 8 |
                 std::popcount(odds & below()) << 16));
    put(odds ? uint32_t(std::countr_zero(odds)) : kAll),
        put(odds ? 31 - uint32_t(std::countl_zero(odds)) : kAll);
    put(warp_.x[first]), put(warp_.has(5) ? warp_.x[5] : kAnything);
  }
  void reductions() {
    put(warp_.over(kAll, 0u, same, kAdd));
    put(uint32_t(warp_.over(
        kAll, 1000, [](uint32_t x) { return int(x) - 100; }, kMin)));
    put(warp_.over(kAll, 0u, same, kMax));
    put(warp_.over(
        kAll, ~0u, [](uint32_t x) { return x | 0x70; }, [](uint32_t a, uint32_t b) { return a & b; }));
    put(warp_.over(kAll, 0u, same, [](uint32_t a, uint32_t b) { return a | b; }));
    put(warp_.over(kAll, 0u, same, [](uint32_t a, uint32_t b) { return a ^ b; }));
    put(warp_.over(kAll, 1u, odd, kMul));
    put(bits(warp_.over(kAll, 0.0f, real, kAdd)));  // exact in any order
    put(bits(warp_.over(
        kAll, -1e9f, [](uint32_t x) { return float(x) - 128.0f; }, kMax)));
  }
  void scans() {
    put(warp_.over(up_to(), 0u, same, kAdd)), put(warp_.over(below(), 0u, same, kAdd));
    put(warp_.over(below(), ~0u, same, kMin));
    put(uint32_t(warp_.over(
        up_to(), -1000, [](uint32_t x) { return int(x) - 128; }, kMax)));
    put(warp_.over(below(), 1u, odd, kMul)), put(bits(warp_.over(up_to(), 0.0f, real, kAdd)));
    const auto wide = [](uint32_t x) { return uint64_t{x} << 30; };
    put64(warp_.over(kAll, uint64_t{0}, wide, kAdd)), put64(warp_.over(below(), uint64_t{0}, wide, kAdd));
    put(bits(warp_.over(
        kAll, 0.0f, [](uint32_t x) { return float(x & 15); }, kAdd)));
    put(warp_.ballot([](uint32_t x) { return x > 3; }) == warp_.active);
    put((warp_.ballot([](uint32_t x) { return x > 200; }) & up_to()) != 0);
    put(uint32_t(std::popcount(warp_.ballot([](uint32_t x) { return (x & 2) != 0; }) & below())) & 1);
  }
  void clusters() {
    const auto cluster = [&](uint32_t size) {
      return (size == 32 ? kAll : ((1u << size) - 1)) << (lane_ & ~(size - 1));
    };
    put(warp_.over(cluster(4), 0u, same, kAdd)), put(bits(warp_.over(cluster(8), 0.0f, real, kMax)));
    put(warp_.over(cluster(2), 1u, odd, kMul));
    const uint32_t part = warp_.ballot([&](uint32_t x) { return (x & 3) == (x_ & 3); });
    put(part), put(warp_.over(part, 0u, same, kAdd)), put(bits(warp_.over(part & below(), 0.0f, real, kAdd)));
    put(1u << lane_ ^ ~below() ^ below());
  }

 public:
  static constexpr uint32_t kAnything = 0x1234'5678;  // undefined: not compared

 private:
  const Warp& warp_;
  uint32_t lane_, x_;
  Words row_;
};

void compare(const uint32_t* got, const Words& expected) {
  REQUIRE(expected.size() <= kWords);
  for (size_t i = 0; i < expected.size(); ++i) {
    INFO("word " << i);
    if (expected[i] != Reference::kAnything) CHECK(got[i] == expected[i]);
  }
}

Words shuffles(const uint32_t* x, uint32_t lane) {
  const uint32_t quad = lane & ~3u;
  return {x[lane ^ 3],
          bits(float(x[lane ^ 16])),
          lane >= 1 ? x[lane - 1] : Reference::kAnything,
          lane < 30 ? x[lane + 2] : Reference::kAnything,
          x[quad | 2],
          x[lane ^ 1] + 1000 * x[lane ^ 2] + 1000000 * x[lane ^ 3]};
}

// Returns the sum over the turns of the loop; lane l makes l % 7 + 1 turns.
uint32_t loop_sum(uint32_t lane) {
  uint32_t sum = 0;
  for (uint32_t i = 0; i <= lane % 7; ++i)
    for (uint32_t other = 0; other < 32; ++other) sum += other % 7 >= i ? i + 1 : 0;
  return sum;
}

TEST_CASE("subgroup operations combine the lanes that execute them, and no others") {
  const Words x = inputs();
  const uint32_t lanes = GENERATE(0xffff'ffffu, 0x8421'0ff1u, 0x0000'0020u, 0x5555'5554u);
  for (const LabOptions& options : compute_lab_options()) {
    INFO(to_string(options) << ", lanes " << lanes);
    ComputeLab lab("compute/subgroups.comp");
    lab.buffers[0] = Words(kThreads * 2 * kWords);
    lab.buffers[1] = x;
    lab.buffers[2] = {lanes, 0, 0, 0};
    lab.run(options);
    for (uint32_t thread = 0; thread < kThreads; ++thread) {
      INFO("thread " << thread);
      const uint32_t lane = thread % 32;
      const uint32_t* row = &lab.buffers[0][thread * 2 * kWords];
      const Warp all{&x[thread - lane], 0xffff'ffff}, some{&x[thread - lane], lanes};
      const Words expected = Reference(all, lane).words();
      CHECK(expected.size() == 43);
      compare(row, expected);
      compare(row + 43, shuffles(all.x, lane));
      if (some.has(lane)) compare(row + kWords, Reference(some, lane).words());
      CHECK(row[kWords + 45] == loop_sum(lane));
    }
  }
}

}  // namespace
}  // namespace glint::test::subgroup_test
