// Defines ops that copy: moves, selections, and the packing of registers.
// SPDX-License-Identifier: Apache-2.0
#include <string_view>
#include <type_traits>

#include "isa/integer_kernels.h"
#include "isa/ops/families.h"
#include "isa/ops/row_tables.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

template <class N>
constexpr auto copy_rows() {
  using T = typename N::Type;
  return joined_rows(
      unary<T>(joined<"mov", N::kName>, Unit::Move, "Copies the bits.", [](T a) { return a; },
               {{{7}, 7}, {{word(T(-2))}, word(T(-2))}}),
      value_op<T, T, bool>(joined<"selp", N::kName>, Unit::Int,
                           "Returns the first source where the predicate is true, else the second.",
                           [](T a, T b, bool p) { return p ? a : b; }, {{{3, 4, 1}, 3}, {{3, 4, 0}, 4}}));
}

// In slct the sign of the third source chooses. Bits are copied, whatever their type.
struct BySign {
  template <class T>
  T operator()(T a, T b, auto c) const {
    return c >= 0 ? a : b;
  }
};
struct ByFlushedSign {
  template <class T>
  T operator()(T a, T b, float c) const {
    return c > -0x1p-126f ? a : b;
  }
};
template <class N>
constexpr auto select_rows() {
  using T = std::make_unsigned_t<typename N::Type>;
  return joined_rows(
      value_op<T, T, int32_t>(joined<"slct", N::kName, ".s32">, Unit::Int,
                              "Returns the first source where the third is 0 or more, else the second.",
                              BySign{}, {{{3, 4, 0}, 3}, {{3, 4, 0xffff'ffff}, 4}}),
      value_op<T, T, float>(joined<"slct", N::kName, ".f32">, Unit::Fp32,
                            "Returns the first source where the third is 0 or more, also for -0, else (also "
                            "for NaN) the second.",
                            BySign{},
                            {{{3, 4, 0x8000'0000}, 3}, {{3, 4, 0x8000'0001}, 4}, {{3, 4, 0x7fc0'0000}, 4}}),
      value_op<T, T, float>(
          joined<"slct.ftz", N::kName, ".f32">, Unit::Fp32,
          "Returns the first source where the third is 0, subnormal or more, else (also for NaN) the second.",
          ByFlushedSign{}, {{{3, 4, 0x8000'0001}, 3}, {{3, 4, 0x8080'0000}, 4}, {{3, 4, 0x7fc0'0000}, 4}}));
}

// Splits a register (pair) into parts, low first, which go to the low ends of `kParts` registers.
template <class T, int kParts>
[[gnu::flatten]] void run_unpack(Warp& warp, const Inst& inst, const OpRow&) {
  constexpr int kPartBits = kBits<T> / kParts;
  const Slot* const slot = &inst.operand.front();
  const Source<T> source(warp, slot[kParts]);
  uint32_t* part[kParts];
  for (int p = 0; p < kParts; ++p) part[p] = warp.bank[0] + slot[p] * kLanes;
  const LaneMask exec = warp.exec;
  all_lanes([&](int i) {
    const T x = source.at(i);
    const bool write = (exec & kLaneBit[i]) != 0;
    uint32_t out[kParts];  // all parts are read first, because a destination may be the source
    for (int p = 0; p < kParts; ++p) {
      const uint32_t bits = uint32_t(x >> (p * kPartBits)) & uint32_t((1ull << kPartBits) - 1);
      out[p] = write ? bits : part[p][i];
    }
    for (int p = 0; p < kParts; ++p) part[p][i] = out[p];
  });
}
template <class T, int kParts>
constexpr OpRow unpack_row(std::string_view name, std::string_view doc, Examples examples) {
  OpRow row;
  row.name = name;
  row.unit = Unit::Move;
  row.operands = {kParts == 2 ? DstVec2 : DstVec4, source_kind<T>()};
  row.run = &run_unpack<T, kParts>;
  row.doc = doc;
  row.examples = examples;
  return row;
}

constexpr auto kPackRows =
    joined_rows(value_op<uint32_t, uint32_t>(
                    "pack.b64", Unit::Move, "Joins a low and a high half to a pair.",
                    [](uint32_t low, uint32_t high) { return uint64_t(low) | uint64_t(high) << 32; },
                    {{{1, 2}, 0x2'0000'0001}, {{0xffff'ffff, 0}, 0xffff'ffff}}),
                value_op<uint16_t, uint16_t>(
                    "pack.b32", Unit::Move, "Joins two 16-bit values, low first.",
                    [](uint16_t low, uint16_t high) { return uint32_t(low) | uint32_t(high) << 16; },
                    {{{1, 2}, 0x2'0001}, {{0xffff, 0}, 0xffff}}),
                value_op<uint32_t, uint32_t>(
                    "pack.b16.b8", Unit::Move, "Joins two bytes to a 16-bit value, low first.",
                    [](uint32_t low, uint32_t high) { return uint16_t((low & 0xff) | (high & 0xff) << 8); },
                    {{{1, 2}, 0x201}, {{0x1ff, 0}, 0xff}}),
                value_op<uint32_t, uint32_t, uint32_t, uint32_t>(
                    "pack.b32.b8", Unit::Move, "Joins four bytes, lowest first.",
                    [](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
                      return (a & 0xff) | (b & 0xff) << 8 | (c & 0xff) << 16 | d << 24;
                    },
                    {{{1, 2, 3, 4}, 0x0403'0201}, {{0x1ff, 0, 0, 0x1ff}, 0xff00'00ff}}),
                value_op<uint16_t, uint16_t, uint16_t, uint16_t>(
                    "pack.b64.b16", Unit::Move, "Joins four 16-bit values to a pair, lowest first.",
                    [](uint16_t a, uint16_t b, uint16_t c, uint16_t d) {
                      return uint64_t(a) | uint64_t(b) << 16 | uint64_t(c) << 32 | uint64_t(d) << 48;
                    },
                    {{{1, 2, 3, 4}, 0x4'0003'0002'0001}, {{0xffff, 0, 0, 0xffff}, 0xffff'0000'0000'ffff}}));

// The examples of two parts give the result as (high, low). Those of four parts show only the lowest part.
constexpr auto kUnpackRows = joined_rows(
    unpack_row<uint64_t, 2>("unpack.b64",
                            "Splits a pair into its low and high half. The example's result is (high, low).",
                            {{{0x1122'3344'5566'7788}, 0x1122'3344'5566'7788}, {{~0ull}, ~0ull}}),
    unpack_row<uint32_t, 2>(
        "unpack.b32", "Splits a register into its low and high 16 bits. The example's result is (high, low).",
        {{{0x1122'3344}, 0x1122'0000'3344}, {{0xffff'ffff}, 0xffff'0000'ffff}}),
    unpack_row<uint16_t, 2>("unpack.b16.b8",
                            "Splits 16 bits into bytes. The example's result is (high, low).",
                            {{{0x1122}, 0x11'0000'0022}, {{0xffff}, 0xff'0000'00ff}}),
    unpack_row<uint32_t, 4>(
        "unpack.b32.b8",
        "Splits a register into four bytes, lowest first. The example's result is the first.",
        {{{0x1122'3344}, 0x44}, {{0xff}, 0xff}}),
    unpack_row<uint64_t, 4>(
        "unpack.b64.b16",
        "Splits a pair into four 16-bit values, lowest first. The example's result is the first.",
        {{{0x1122'3344'5566'7788}, 0x7788}, {{0xffff}, 0xffff}}));

constexpr auto kRows =
    joined_rows(rows_of_types<TypeB16, TypeB32, TypeB64>([]<class N>() { return copy_rows<N>(); }),
                rows_of_types<TypeB16, TypeB32, TypeB64, TypeU16, TypeU32, TypeU64, TypeS16, TypeS32, TypeS64,
                              Named<uint32_t, ".f32">, Named<uint64_t, ".f64">>(
                    []<class N>() { return select_rows<N>(); }),
                kPackRows, kUnpackRows);

}  // namespace

RowList move_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
