// Tests what follows from the rows of the op table alone: examples, masks, and equal bits on all SIMD paths.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <map>
#include <set>
#include <string>

#include "isa/atomic.h"
#include "isa/paths.h"
#include "tests/isa/warp_fixture.h"
#include "tests/support/catch.h"

using namespace glint;
using namespace glint::isa;

namespace {

constexpr LaneMask kSparse = 0x8421'0f07;

// Uses xorshift64*, which gives the same inputs on every machine.
uint64_t next_random(uint64_t& state) {
  state ^= state >> 12;
  state ^= state << 25;
  state ^= state >> 27;
  return state * 0x2545'f491'4f6c'dd1dull;
}

// These bits often go wrong: zeros, ones, extremes of integers and floats, NaN, subnormals, shift counts.
constexpr uint32_t kCorners[] = {
    0,           1,           2,           7,           31,          32,          33,          63,
    64,          255,         0x7fff'ffff, 0x8000'0000, 0x8000'0001, 0xffff'ffff, 0xffff'fffe, 0x3f80'0000,
    0xbf80'0000, 0x3f00'0000, 0xbfc0'0000, 0x7f80'0000, 0xff80'0000, 0x7fc0'0000, 0x7f80'0001, 0xffc0'1234,
    0x0080'0000, 0x007f'ffff, 0x4f00'0000, 0x4f80'0000, 0xcf00'0000, 0x4b00'0001, 0x7f7f'ffff, 0x4049'0fdb};

uint32_t test_word(uint64_t& state) {
  const uint64_t r = next_random(state);
  switch (r >> 62) {
    case 0:
      return kCorners[(r >> 32) % std::size(kCorners)];
    case 1:
      return 0x3000'0000u + (uint32_t(r) & 0x9fff'ffffu);  // floats of moderate size
    default:
      return uint32_t(r >> 8);
  }
}

std::vector<Path> paths() {
  std::vector<Path> out;
  for (int p = 0; p < int(Path::Count); ++p)
    if (is_supported(Path(p))) out.push_back(Path(p));
  return out;
}

// Returns the words of every predicate and register, as WarpFixture::snapshot() orders them. Thousands of ops
// run on the words of each seed, so that they are kept.
const std::vector<uint32_t>& random_words(uint64_t seed) {
  static std::map<uint64_t, std::vector<uint32_t>> kept;
  std::vector<uint32_t>& words = kept[seed];
  if (!words.empty()) return words;
  for (int p = 0; p < kNumPredicates; ++p) words.push_back(LaneMask(next_random(seed)));
  for (int i = 0; i < WarpFixture::kRows * kLanes; ++i) words.push_back(test_word(seed));
  return words;
}

// Fills every register and predicate, runs the op, and returns all registers and predicates.
std::vector<uint32_t> run_random(const OpRow& row, uint16_t op, uint64_t seed, LaneMask exec) {
  static WarpFixture w;
  const std::vector<uint32_t>& words = random_words(seed);
  std::copy_n(words.begin(), kNumPredicates, w.warp.predicate.begin());
  std::copy(words.begin() + kNumPredicates, words.end(), w.warp.bank[0]);
  w.warp.exec = exec;
  row.run(w.warp, spread(row, op), row);
  return w.snapshot();
}

}  // namespace

TEST_CASE("every row is complete: a name of its own, a sentence, a handler and two examples if it computes") {
  std::set<std::string> names;
  for (const OpRow& row : op_table()) {
    INFO(row.name);
    CHECK(names.insert(std::string(row.name)).second);
    CHECK(row.doc.ends_with("."));
    CHECK(row.run != nullptr);
    CHECK(find_op(row.name) == &row - op_table().data());
    // Activemask has only one operand.
    if (is_value_op(row) && row.operands.count > 1) CHECK(row.examples.count >= 2);
    int slots = 0;
    for (const OperandKind kind : row.operands.view()) slots += slots_of(kind);
    CHECK(slots <= kMaxOperands);
  }
  CHECK(find_op("add.u31") == -1);
}

TEST_CASE("an atomic names its reduction: the same op without the old value") {
  for (const OpRow& row : op_table()) {
    INFO(row.name);
    const bool gives_old_value = row.effect == Effect::Atomic && is_destination(row.operands.kind[0]);
    const int red = gives_old_value ? find_op("red" + std::string(row.name.substr(row.name.find('.')))) : -1;
    CHECK(row.reduction == (red < 0 ? "" : op_table()[size_t(red)].name));
    if (red < 0) continue;
    const OpRow& reduction = op_table()[size_t(red)];
    CHECK(reduction.effect == Effect::Atomic);
    CHECK(reduction.atomic == row.atomic);
    CHECK(reduction.detail == row.detail);
    CHECK(reduction.operands.count + 1 == row.operands.count);
  }
}

TEST_CASE("the kind of an atomic is that of its function") {
  const auto kind_of = [](std::string_view name) { return AtomicKind(op_table()[op_index(name)].detail); };
  CHECK(kind_of("atom.shared.add.u32") == AtomicKind::Integer);
  CHECK(kind_of("atom.shared.add.noftz.f16x2") == AtomicKind::Integer);
  CHECK(kind_of("atom.shared.exch.b32") == AtomicKind::Integer);
  CHECK(kind_of("atom.shared.cas.b64") == AtomicKind::Swap);
  CHECK(kind_of("atom.global.cas.b16") == AtomicKind::Swap);
  CHECK(kind_of("red.shared.add.f32") == AtomicKind::FloatAdd);
  CHECK(kind_of("atom.add.f64") == AtomicKind::FloatAdd);
}

TEST_CASE("the rows have the same names in the same order on every path") {
  for (int p = 0; p < int(Path::Count); ++p) {
    const std::span<const OpRow> table = op_table(Path(p));
    REQUIRE(table.size() == op_table().size());
    for (size_t i = 0; i < table.size(); ++i) CHECK(table[i].name == op_table()[i].name);
  }
  uint16_t first = 0;
  for (const Family& family : families()) {
    CHECK(family.first == first);
    first = uint16_t(first + family.count);
  }
  CHECK(first == op_table().size());
}

TEST_CASE(
    "each example holds on every path under full and sparse masks, and inactive lanes keep their values") {
  for (const Path path : paths())
    for (const OpRow& row : op_table(path))
      for (const Example& example : row.examples.view())
        for (const LaneMask exec : {kAllLanes, kSparse, LaneMask{0}}) {
          WarpFixture w;
          const Inst inst = spread(row, 0);
          size_t input = 0;
          int slot = 0;
          for (const OperandKind kind : row.operands.view()) {
            if (!is_destination(kind)) {
              for (int part = 0; part < slots_of(kind); ++part)  // An input fills all parts of a vector.
                for (int lane = 0; lane < kLanes; ++lane)
                  w.set(kind, inst.operand[slot + part], lane, example.in[input]);
              ++input;
            }
            slot += slots_of(kind);
          }
          w.warp.predicate[0] |= 0x5555'0000;  // an old value of the destination
          WarpFixture before;
          before.warp.predicate = w.warp.predicate;
          w.warp.exec = exec;
          row.run(w.warp, inst, row);
          const OperandKind kind = row.operands.kind[0];
          INFO(name_of(path) << " " << row.name << " mask " << exec);
          int wrong = 0;
          for (int lane = 0; lane < kLanes; ++lane) {
            const bool is_active = exec >> lane & 1;
            const uint64_t expected = is_active ? example.out : before.get(kind, inst.operand[0], lane);
            wrong += w.get(kind, inst.operand[0], lane) != expected;
            const OperandKind other = row.operands.kind[1];
            if (row.operands.count < 2 || slots_of(kind) != 1 || !is_destination(other)) continue;
            if (row.unit == Unit::Shuffle) continue;  // the lanes' answers differ
            const uint64_t second = is_active ? example.second : before.get(other, inst.operand[1], lane);
            wrong += w.get(other, inst.operand[1], lane) != second;
          }
          CHECK(wrong == 0);
        }
}

TEST_CASE("every value op gives the same bits on every path for random and extreme inputs") {
  for (size_t op = 0; op < op_table().size(); ++op) {
    const OpRow& row = op_table(Path::Baseline)[op];
    if (!is_value_op(row)) continue;
    INFO(row.name);
    int different = 0;
    for (uint64_t round = 0; round < 200; ++round) {
      const LaneMask exec = round % 2 ? kSparse : kAllLanes;
      const auto expected = run_random(row, uint16_t(op), round * 977 + 1, exec);
      for (const Path path : paths())
        different += run_random(op_table(path)[op], uint16_t(op), round * 977 + 1, exec) != expected;
    }
    CHECK(different == 0);
  }
}

TEST_CASE("results that only rounding lifts to the least normal number are flushed, on every path alike") {
  // The sources are normal numbers and zeros whose product, quotient or fused sum lies near 2^-126.
  const auto fill = [](WarpFixture& w, uint64_t seed) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const uint64_t r = next_random(seed);
      const uint32_t fraction = uint32_t(r) & 0x007f'ffff, sign = uint32_t(r >> 32) & 0x8000'0000;
      const float a = std::bit_cast<float>((120 + uint32_t(r >> 40) % 6) << 23 |
                                           (r >> 60 ? fraction : 0x7f'ffff)),
                  step = 1.0f + float(int(r >> 48 & 7) - 4) * 0x1p-23f;
      float b = 0x1p-126f / a * step, c = 0;
      if (seed % 3 == 1) b = a * 0x1p126f * step;
      if (seed % 3 == 2) b = 0x1p-64f / a, c = 0x1p-126f;
      w.at(2, lane) = std::bit_cast<uint32_t>(c != 0 ? a * 0x1p-87f * step : a) | sign;
      w.at(4, lane) = std::bit_cast<uint32_t>(b);
      w.at(6, lane) = std::bit_cast<uint32_t>(c) | (r >> 62 == 0 ? 0 : sign ^ 0x8000'0000);
    }
  };
  int lifted = 0;
  for (size_t op = 0; op < op_table().size(); ++op) {
    const OpRow& row = op_table(Path::Baseline)[op];
    if (row.name.find(".ftz") == row.name.npos || !row.name.ends_with(".f32") ||
        row.name.starts_with("cvt") || row.operands.kind[0] != OperandKind::Dst32 || !is_value_op(row))
      continue;
    std::string kept(row.name);
    kept.erase(kept.find(".ftz"), 4);
    const int other = find_op(kept);
    INFO(row.name);
    int different = 0;
    for (uint64_t seed = 1; seed < 200; ++seed) {
      const auto run = [&](const OpRow& of) {
        WarpFixture w;
        fill(w, seed);
        w.warp.exec = kAllLanes;
        of.run(w.warp, spread(of, 0), of);
        return std::vector<uint32_t>(&w.at(0, 0), &w.at(0, 0) + kLanes);
      };
      const auto expected = run(row);
      for (const Path path : paths()) different += run(op_table(path)[op]) != expected;
      if (other < 0) continue;
      const auto unflushed = run(op_table(Path::Baseline)[size_t(other)]);
      for (int lane = 0; lane < kLanes; ++lane)
        lifted += (unflushed[size_t(lane)] & 0x7fff'ffff) == 0x0080'0000 &&
                  (expected[size_t(lane)] & 0x7fff'ffff) == 0;
    }
    CHECK(different == 0);
  }
  CHECK(lifted > 1000);  // checks that the sources do reach such results
}

TEST_CASE("a masked run equals the full run on its lanes and changes nothing else") {
  for (const Path path : paths())
    for (size_t op = 0; op < op_table().size(); ++op) {
      const OpRow& row = op_table(path)[op];
      // These ops depend on which lanes execute.
      if (!is_value_op(row) || row.unit == Unit::Shuffle) continue;
      INFO(name_of(path) << " " << row.name);
      const auto full = run_random(row, uint16_t(op), 77, kAllLanes);
      const auto none = run_random(row, uint16_t(op), 77, 0);
      const auto some = run_random(row, uint16_t(op), 77, kSparse);
      int wrong = 0;
      for (size_t i = 0; i < kNumPredicates; ++i)
        wrong += some[i] != ((full[i] & kSparse) | (none[i] & ~kSparse));
      for (size_t i = kNumPredicates; i < some.size(); ++i)
        wrong += some[i] != (kSparse >> ((i - kNumPredicates) % kLanes) & 1 ? full : none)[i];
      CHECK(wrong == 0);
    }
}

TEST_CASE("a destination may be any of its sources") {
  for (const Path path : paths())
    for (size_t op = 0; op < op_table().size(); ++op) {
      const OpRow& row = op_table(path)[op];
      if (!is_value_op(row) || row.operands.kind[0] == OperandKind::DstVec2 ||
          row.operands.kind[0] == OperandKind::DstVec4)
        continue;
      Inst apart = spread(row, uint16_t(op)), same = apart;
      for (int s = 1; s < row.operands.count; ++s)
        if (!is_destination(row.operands.kind[s]) &&
            WarpFixture::is_wide(row.operands.kind[s]) == WarpFixture::is_wide(row.operands.kind[0]) &&
            (row.operands.kind[s] == OperandKind::SrcPred) ==
                (row.operands.kind[0] == OperandKind::DstPred)) {
          same.operand[0] = apart.operand[s];
          WarpFixture a, b;
          uint64_t seed = 5 + op;
          for (int r = 0; r < WarpFixture::kRows; ++r)
            for (int lane = 0; lane < kLanes; ++lane) a.at(r, lane) = b.at(r, lane) = test_word(seed);
          for (int p = 0; p < kNumPredicates; ++p)
            a.warp.predicate[p] = b.warp.predicate[p] = uint32_t(next_random(seed));
          a.warp.exec = b.warp.exec = s % 2 ? kAllLanes : kSparse;
          row.run(a.warp, apart, row);
          row.run(b.warp, same, row);
          int wrong = 0;
          for_each_lane(a.warp.exec, [&](int lane) {
            wrong += a.get(row.operands.kind[0], apart.operand[0], lane) !=
                     b.get(row.operands.kind[0], same.operand[0], lane);
          });
          INFO(name_of(path) << " " << row.name << " source " << s);
          CHECK(wrong == 0);
        }
    }
}

TEST_CASE("memory and texture ops form the addresses of the active lanes and touch no register") {
  for (const Path path : paths())
    for (size_t op = 0; op < op_table().size(); ++op) {
      const OpRow& row = op_table(path)[op];
      if (row.klass != Class::Mem && row.klass != Class::Tex) continue;
      INFO(name_of(path) << " " << row.name);
      WarpFixture w;
      Inst inst = spread(row, uint16_t(op));
      int slot = 0, at = -1;
      bool is_wide = false;
      for (const OperandKind kind : row.operands.view()) {
        if (at < 0 && (kind == OperandKind::Address64 || kind == OperandKind::Address32 ||
                       kind == OperandKind::Src32)) {
          if (row.klass == Class::Tex || kind != OperandKind::Src32)
            at = slot, is_wide = kind == OperandKind::Address64;
        }
        slot += slots_of(kind);
      }
      REQUIRE(at >= 0);
      inst.imm = row.klass == Class::Tex ? 0 : -16;
      for (int lane = 0; lane < kLanes; ++lane)
        w.set(is_wide ? OperandKind::Src64 : OperandKind::Src32, inst.operand[at], lane,
              is_wide ? 0x1'0000'0008ull + uint64_t(lane) * 4 : uint64_t(lane) * 4);
      const auto before = w.snapshot();
      w.warp.exec = kSparse;
      row.run(w.warp, inst, row);
      CHECK(w.snapshot() == before);
      for_each_lane(kSparse, [&](int lane) {
        const uint64_t base = is_wide ? 0x1'0000'0008ull + uint64_t(lane) * 4 : uint64_t(lane) * 4;
        const uint64_t sum = base + uint64_t(int64_t(inst.imm));
        CHECK(w.warp.access.address[lane] == (is_wide ? sum : uint32_t(sum)));
      });
    }
}
