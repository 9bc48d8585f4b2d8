// Tests what keeps the work of register allocation linear: sets that take memory only for their members, and
// the relief of programs with too many values.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/relief.h"

#include <random>
#include <set>

#include "frontend/backend/pair_set.h"
#include "tests/support/catch.h"
#include "tests/unit/backend/code_builder.h"

namespace glint::frontend::test {
namespace {

// Returns code with `values` words that are all live at once. The first word is needed first, so that all
// live equally long and many are left when some are spilled.
VirtualProgram crowd(int values) {
  CodeBuilder code;
  const Operand address = code.pair();
  std::vector<Operand> words;
  for (int i = 0; i < values; ++i) words.push_back(code.word(4 * i));
  for (int i = 0; i < values; ++i) code.add("st.global.b32", {address, words[size_t(i)]}, 4 * i);
  code.add("exit");
  return code.program;
}

uint64_t edges_of(const VirtualProgram& program) {
  return count_edges(program, find_liveness(program), RegisterFile::Registers);
}

VirtualProgram relieved(VirtualProgram program, uint64_t most_edges) {
  std::vector<bool> unspillable(program.registers.size());
  relieve(program, RegisterFile::Registers, 64, {}, unspillable, most_edges);
  return program;
}

TEST_CASE("Values that all live at once have an edge for each pair, and few when they are relieved") {
  for (const uint64_t values : {1000u, 2000u}) {
    const VirtualProgram program = crowd(int(values));
    // The address is one more value.
    REQUIRE(edges_of(program) == (values + 1) * values / 2);
    const uint64_t left = edges_of(relieved(program, 0));
    REQUIRE(left >= values * 40);
    REQUIRE(left <= 2 * values * 64);
  }
}

TEST_CASE("A program with no more edges than allowed is not relieved") {
  const VirtualProgram program = crowd(100);
  const uint64_t edges = edges_of(program);
  REQUIRE(relieved(program, edges).blocks[0].code.size() == program.blocks[0].code.size());
  REQUIRE(relieved(program, edges - 1).blocks[0].code.size() > program.blocks[0].code.size());
}

TEST_CASE("Pairs of near numbers take memory that grows with the numbers and not with their square") {
  for (const size_t numbers : {size_t{6'400}, size_t{64'000}}) {
    PairSet set(numbers);
    for (size_t i = 1; i < numbers; ++i) set.insert(i, i - 1);
    REQUIRE(set.num_tiles() == 2 * numbers / 64 - 1);
    for (size_t i = 2; i < numbers; ++i) {
      REQUIRE(set.contains(i - 1, i));
      REQUIRE_FALSE(set.contains(i, i - 2));
    }
  }
}

TEST_CASE("Sets of registers are united, cut and diminished as sets of numbers are") {
  constexpr uint32_t kRegisters = 3000;
  std::mt19937 random(5);
  for (int round = 0; round < 50; ++round) {
    std::set<VirtualRegister> a, b;
    RegisterSet of_a(kRegisters), of_b(kRegisters);
    for (int i = 0; i < 60; ++i) {
      const uint32_t r = uint32_t(random() % kRegisters), s = uint32_t(random() % 600);
      a.insert(r), of_a.insert(r), b.insert(s), of_b.insert(s);
      a.erase(s), of_a.erase(s);
    }
    const auto same = [](const RegisterSet& set, const std::set<VirtualRegister>& expected) {
      std::vector<VirtualRegister> got;
      set.for_each([&](VirtualRegister r) { got.push_back(r); });
      REQUIRE(got == std::vector<VirtualRegister>(expected.begin(), expected.end()));
      REQUIRE(set.size() == expected.size());
      for (uint32_t r = 0; r < kRegisters; ++r) REQUIRE(set.contains(r) == (expected.count(r) > 0));
    };
    std::set<VirtualRegister> both = a, common, rest;
    both.insert(b.begin(), b.end());
    for (const VirtualRegister r : a) (b.count(r) ? common : rest).insert(r);
    RegisterSet united = of_a, cut = of_a, diminished = of_a;
    REQUIRE(united.unite(of_b) == (both.size() > a.size()));
    REQUIRE_FALSE(united.unite(of_a));
    cut.intersect(of_b);
    diminished.subtract(of_b);
    same(united, both);
    same(cut, common);
    same(diminished, rest);
  }
}

}  // namespace
}  // namespace glint::frontend::test
