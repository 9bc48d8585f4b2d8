// Ops that copy: moves, selections, and the packing of register pairs.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// unpack.b64: operands low, high (any two registers), pair.
[[gnu::flatten]] void run_unpack(Warp& warp, const Inst& inst) {
  const Slot* const slot = &inst.operand.front();
  const Source<uint64_t> source(warp, slot[2]);
  uint32_t* const low = warp.bank[0] + slot[0] * kLanes;
  uint32_t* const high = warp.bank[0] + slot[1] * kLanes;
  const LaneMask exec = warp.exec;
  all_lanes([&](int i) {
    const uint64_t x = source.at(i);
    const bool write = (exec & kLaneBit[i]) != 0;
    const uint32_t old_low = low[i], old_high = high[i];
    low[i] = write ? uint32_t(x) : old_low;
    high[i] = write ? uint32_t(x >> 32) : old_high;
  });
}

constexpr OpRow unpack_row() {
  OpRow row;
  row.name = "unpack.b64";
  row.unit = Unit::Move;
  row.operands = {DstVec2, Src64};
  row.run = &run_unpack;
  row.doc = "Splits a pair into its low and high half; the example's result is (high, low).";
  row.examples = {{{0x1122'3344'5566'7788}, 0x1122'3344'5566'7788}, {{~0ull}, ~0ull}};
  return row;
}

constexpr OpRow kRows[] = {
    unary<uint32_t>("mov.b32", Unit::Move, "Copies 32 bits.", [](uint32_t a) { return a; },
                    {{{7}, 7}, {{0x7f80'0001}, 0x7f80'0001}}),
    unary<uint64_t>("mov.b64", Unit::Move, "Copies 64 bits.", [](uint64_t a) { return a; },
                    {{{7}, 7}, {{0x1122'3344'5566'7788}, 0x1122'3344'5566'7788}}),
    value_op<uint32_t, uint32_t, bool>(
        "selp.b32", Unit::Int, "The first source where the predicate is true, else the second.",
        [](uint32_t a, uint32_t b, bool p) { return p ? a : b; }, {{{3, 4, 1}, 3}, {{3, 4, 0}, 4}}),
    value_op<uint64_t, uint64_t, bool>("selp.b64", Unit::Int,
                                       "The first source where the predicate is true, else the second.",
                                       [](uint64_t a, uint64_t b, bool p) { return p ? a : b; },
                                       {{{1ull << 40, 4, 1}, 1ull << 40}, {{1ull << 40, 4, 0}, 4}}),
    value_op<uint32_t, uint32_t>(
        "pack.b64", Unit::Move, "Joins a low and a high half to a pair.",
        [](uint32_t low, uint32_t high) { return uint64_t(low) | uint64_t(high) << 32; },
        {{{1, 2}, 0x2'0000'0001}, {{0xffff'ffff, 0}, 0xffff'ffff}}),
    unpack_row(),
};

}  // namespace

RowList move_rows() {
  return {kRows, std::size(kRows)};
}

}  // namespace glint::isa::GLINT_ISA_PATH
