// Defines products of matrices that a warp holds in its registers, as tensor cores compute them.
// SPDX-License-Identifier: Apache-2.0
//
// All lanes hold parts of the matrices (isa/matrix_fragments.h). Choice: of a lane that does not execute, the
// registers are read as they are, which PTX leaves open, and are not written.
#include <cstdint>
#include <string_view>

#include "isa/double_nans.h"
#include "isa/float_products.h"
#include "isa/integer_kernels.h"
#include "isa/ops/families.h"
#include "isa/ops/modifiers.h"
#include "isa/ops/row_tables.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

constexpr OperandKind vector_to(int registers) {
  return registers == 4 ? DstVec4 : registers == 2 ? DstVec2 : Dst32;
}
constexpr OperandKind vector_from(int registers) {
  return registers == 4 ? SrcVec4 : registers == 2 ? SrcVec2 : Src32;
}

// Makes a row; kSums is the number of registers of C and of D.
template <class S, int kSums>
constexpr OpRow product_row(std::string_view name, std::string_view doc, Handler run, Examples examples) {
  OpRow row = effect_op(
      name, Class::Alu, Unit::Tensor, Effect::None,
      {vector_to(kSums), vector_from(S::kRegistersA), vector_from(S::kRegistersB), vector_from(kSums)}, doc);
  row.run = run;
  row.examples = examples;
  return row;
}

constexpr uint32_t kHalfOnes = 0x3c00'3c00, kHalfTwos = 0x4000'4000, kBfloatOnes = 0x3f80'3f80,
                   kBfloatTwos = 0x4000'4000, kFloatOne = 0x3f80'0000, kFloatTwo = 0x4000'0000,
                   kFloatHalf = 0x3f00'0000;
constexpr uint32_t kHalfHalves = 0x3800'3800;

// In the examples all elements of a matrix are equal, so that the result is depth * a * b + c.
template <Text kShape, class S>
constexpr auto float_rows_of_shape() {
  constexpr uint64_t kSum = S::kK == 16 ? 0x4204'0000 : 0x4188'0000;       // 2 * K + 1
  constexpr uint64_t kHalves = S::kK == 16 ? 0x5020'5020 : 0x4c40'4c40;    // the same as a pair of halves
  constexpr uint64_t kPlusHalf = S::kK == 16 ? 0x4184'0000 : 0x4108'0000;  // K + 1/2
  return joined_rows(
      product_row<S, 4>(
          joined<"mma.sync.aligned.", kShape, ".row.col.f32.f16.f16.f32">,
          "Multiplies matrices of halves, and adds a matrix of single precision.",
          &multiply_floats<FormatF16, FormatF32, S>,
          {{{kHalfOnes, kHalfTwos, kFloatOne}, kSum}, {{kHalfOnes, kHalfOnes, kFloatHalf}, kPlusHalf}}),
      product_row<S, 2>(joined<"mma.sync.aligned.", kShape, ".row.col.f16.f16.f16.f16">,
                        "Multiplies and adds matrices of halves.", &multiply_floats<FormatF16, FormatF16, S>,
                        {{{kHalfOnes, kHalfTwos, kHalfOnes}, kHalves << 32 | kHalves},
                         {{0, kHalfOnes, kHalfHalves}, uint64_t{kHalfHalves} << 32 | kHalfHalves}}),
      product_row<S, 4>(joined<"mma.sync.aligned.", kShape, ".row.col.f32.bf16.bf16.f32">,
                        "Multiplies matrices of bf16, and adds a matrix of single precision.",
                        &multiply_floats<FormatBf16, FormatF32, S>,
                        {{{kBfloatOnes, kBfloatTwos, kFloatOne}, kSum},
                         {{kBfloatOnes, kBfloatOnes, kFloatHalf}, kPlusHalf}}));
}
template <Text kShape, class S>
constexpr OpRow tf32_row() {
  constexpr uint64_t kSum = S::kK == 8 ? 0x4188'0000 : 0x4110'0000;  // 2 * K + 1
  return product_row<S, 4>(
      joined<"mma.sync.aligned.", kShape, ".row.col.f32.tf32.tf32.f32">,
      "Multiplies matrices of tf32, and adds a matrix of single precision. The low 13 bits of factors are "
      "dropped.",
      &multiply_floats<FormatTf32, FormatF32, S>,
      {{{kFloatOne, kFloatTwo, kFloatOne}, kSum}, {{kFloatOne | 0x1fff, kFloatTwo, kFloatOne}, kSum}});
}

// Integers. With kBits of 1 an element is a word of 32 bits, and a product counts the bits of its `and` or
// `xor`.
enum class Combine { Product, And, Xor };
template <class S, bool kSignedA, bool kSignedB, Combine kCombine, bool kSaturate>
[[gnu::flatten]] void multiply_integers(Warp& warp, const Inst& inst, const OpRow&) {
  constexpr int kSums = 2 * S::kHalves, kFill = 32 - S::kBits;
  const Slot *const d = &inst.operand.front(), *const at_a = d + kSums, *const at_b = at_a + S::kRegistersA,
                    *const at_c = at_b + S::kRegistersB;
  alignas(64) uint32_t a[S::kA], b[S::kB], c[S::kC], out[S::kC];
  read_a<S>(warp, at_a, a);
  read_b<S>(warp, at_b, b);
  read_c<S, 32>(warp, at_c, c);
  if constexpr (kSignedA)
    for (uint32_t& x : a) x = uint32_t(int32_t(x << kFill) >> kFill);
  if constexpr (kSignedB)
    for (uint32_t& x : b) x = uint32_t(int32_t(x << kFill) >> kFill);
  for (int column = 0; column < S::kN; ++column) {
    alignas(64) uint32_t sum[S::kM] = {};
    for (int k = 0; k < S::kK; ++k) {
      const uint32_t y = b[k * S::kN + column];
      for (int m = 0; m < S::kM; ++m) {
        const uint32_t x = a[k * S::kM + m];
        if constexpr (kCombine == Combine::Product) sum[m] += x * y;
        if constexpr (kCombine == Combine::And) sum[m] += count_ones(x & y);
        if constexpr (kCombine == Combine::Xor) sum[m] += count_ones(x ^ y);
      }
    }
    for (int m = 0; m < S::kM; ++m) {
      const uint32_t summand = c[column * S::kM + m];
      const int64_t exact = int64_t{int32_t(sum[m])} + int32_t(summand);
      const int64_t clamped = exact > INT32_MAX ? INT32_MAX : exact < INT32_MIN ? INT32_MIN : exact;
      out[column * S::kM + m] = kSaturate ? uint32_t(clamped) : sum[m] + summand;
    }
  }
  write_d<S, 32>(warp, d, out);
}

// The examples have the bytes -1 or 255 in all places, and the sums of an instruction in 32 bits.
template <Text kShape, class S, Text kA, Text kB, Text kSat>
constexpr OpRow integer_row() {
  constexpr bool kSignedA = kA.at[0] == 's', kSignedB = kB.at[0] == 's', kClamps = kSat.kLength > 0;
  constexpr int64_t kLargest = S::kMask, kFromA = kSignedA ? -1 : kLargest, kFromB = kSignedB ? -1 : kLargest;
  constexpr auto result = [](int64_t c) {
    const int64_t exact = S::kK * kFromA * kFromB + c;
    return uint64_t{uint32_t(kClamps && exact > INT32_MAX   ? INT32_MAX
                             : kClamps && exact < INT32_MIN ? INT32_MIN
                                                            : exact)};
  };
  constexpr auto pair = [](uint64_t x) { return S::kHalves == 1 ? x << 32 | x : x; };
  return product_row<S, 2 * S::kHalves>(
      joined<"mma.sync.aligned.", kShape, ".row.col", kSat, ".s32.", kA, ".", kB, ".s32">,
      joined<"Multiplies matrices of integers of ", when<S::kBits == 8, "8">, when<S::kBits == 4, "4">,
             " bits, and adds a matrix of integers of 32 bits", when<kClamps, ", clamped">, ".">,
      &multiply_integers<S, kSignedA, kSignedB, Combine::Product, kClamps>,
      {{{~0u, ~0u, 5}, pair(result(5))},
       {{~0u, ~0u, 0x7fff'ffff}, pair(result(INT32_MAX))},
       {{~0u, ~0u, 0x8000'0000}, pair(result(INT32_MIN))}});
}
template <Text kShape, class S, Text kSigned, Text kUnsigned>
constexpr auto integer_rows_of_shape() {
  return rows_of_names<"", ".satfinite">([]<Text kSat>() {
    return joined_rows(integer_row<kShape, S, kSigned, kSigned, kSat>(),
                       integer_row<kShape, S, kSigned, kUnsigned, kSat>(),
                       integer_row<kShape, S, kUnsigned, kSigned, kSat>(),
                       integer_row<kShape, S, kUnsigned, kUnsigned, kSat>());
  });
}
template <Text kShape, class S>
constexpr auto bit_rows_of_shape() {
  constexpr uint64_t kAll = 32 * S::kK;
  constexpr auto pair = [](uint64_t x) { return S::kHalves == 1 ? x << 32 | x : x; };
  return joined_rows(
      product_row<S, 2 * S::kHalves>(
          joined<"mma.sync.aligned.", kShape, ".row.col.s32.b1.b1.s32.and.popc">,
          "Counts the bits that a row of one matrix and a column of the other have in common, and adds.",
          &multiply_integers<S, false, false, Combine::And, false>,
          {{{~0u, ~0u, 5}, pair(kAll + 5)}, {{~0u, 0, 5}, pair(5)}}),
      product_row<S, 2 * S::kHalves>(
          joined<"mma.sync.aligned.", kShape, ".row.col.s32.b1.b1.s32.xor.popc">,
          "Counts the bits in which a row of one matrix and a column of the other differ, and adds.",
          &multiply_integers<S, false, false, Combine::Xor, false>,
          {{{~0u, ~0u, 5}, pair(5)}, {{~0u, 0, 5}, pair(kAll + 5)}}));
}

// Lane 4g + t holds element (g, t) of A, (t, g) of B, and (g, 2t) and (g, 2t + 1) of C and D. The products
// are added one by one in the order of k, each with one rounding; so says an H200 (isa/float_products.h).
[[gnu::flatten]] void multiply_doubles(Warp& warp, const Inst& inst, const OpRow&) {
  const Slot* const slot = &inst.operand.front();
  const Source<double> a(warp, slot[2]), b(warp, slot[3]), c[] = {{warp, slot[4]}, {warp, slot[5]}};
  alignas(64) uint64_t out[2][kLanes];
  for (int j = 0; j < 2; ++j)
    for (int lane = 0; lane < kLanes; ++lane) {
      double sum = c[j].at(lane);
      for (int k = 0; k < 4; ++k) {
        const double x = a.at(lane / 4 * 4 + k), y = b.at((2 * (lane % 4) + j) * 4 + k);
        sum = with_nan(__builtin_fma(x, y, sum), y, sum, x);
      }
      out[j][lane] = double_bits(sum);
    }
  for (int j = 0; j < 2; ++j) write_lanes<double>(warp, slot[j], [&](int i) { return double_of(out[j][i]); });
}
constexpr OpRow double_row() {
  OpRow row = effect_op("mma.sync.aligned.m8n8k4.row.col.f64.f64.f64.f64", Class::Alu, Unit::Tensor,
                        Effect::None, {Dst64, Dst64, Src64, Src64, Src64, Src64},
                        "Multiplies and adds matrices of double precision.");
  row.run = &multiply_doubles;
  constexpr uint64_t kOne = 0x3ff0'0000'0000'0000, kTwo = 0x4000'0000'0000'0000,
                     kNine = 0x4022'0000'0000'0000, kTen = 0x4024'0000'0000'0000;
  row.examples = {{{kOne, kTwo, kOne, kTwo}, kNine, kTen}, {{0, kTwo, kOne, kTwo}, kOne, kTwo}};
  return row;
}

// Exchanges rows and columns of a matrix of 8x8 half words: lane 4g + t holds elements (g, 2t) and
// (g, 2t + 1).
[[gnu::flatten]] void transpose(Warp& warp, const Inst& inst, const OpRow&) {
  const Slot* const slot = &inst.operand.front();
  const uint32_t* const from = Source<uint32_t>(warp, slot[1]).low;
  alignas(64) uint32_t out[kLanes];
  for (int lane = 0; lane < kLanes; ++lane) {
    const int row = lane / 4, column = 2 * (lane % 4);
    const auto element = [&](int r) { return from[4 * r + row / 2] >> (16 * (row % 2)) & 0xffffu; };
    out[lane] = element(column) | element(column + 1) << 16;
  }
  write_lanes<uint32_t>(warp, slot[0], [&](int i) { return out[i]; });
}
constexpr OpRow transpose_row() {
  OpRow row = effect_op("movmatrix.sync.aligned.m8n8.trans.b16", Class::Alu, Unit::Shuffle, Effect::None,
                        {Dst32, Src32}, "Exchanges rows and columns of a matrix of 8x8 half words.");
  row.run = &transpose;
  row.examples = {{{0x1234'1234}, 0x1234'1234}, {{0x8000'8000}, 0x8000'8000}};
  return row;
}

constexpr auto kRows =
    joined_rows(float_rows_of_shape<"m16n8k8", MatrixShape<16, 8, 16>>(),
                float_rows_of_shape<"m16n8k16", MatrixShape<16, 16, 16>>(),
                tf32_row<"m16n8k4", MatrixShape<16, 4, 32>>(), tf32_row<"m16n8k8", MatrixShape<16, 8, 32>>(),
                double_row(), integer_rows_of_shape<"m8n8k16", MatrixShape<8, 16, 8>, "s8", "u8">(),
                integer_rows_of_shape<"m16n8k16", MatrixShape<16, 16, 8>, "s8", "u8">(),
                integer_rows_of_shape<"m16n8k32", MatrixShape<16, 32, 8>, "s8", "u8">(),
                integer_rows_of_shape<"m8n8k32", MatrixShape<8, 32, 4>, "s4", "u4">(),
                integer_rows_of_shape<"m16n8k32", MatrixShape<16, 32, 4>, "s4", "u4">(),
                integer_rows_of_shape<"m16n8k64", MatrixShape<16, 64, 4>, "s4", "u4">(),
                bit_rows_of_shape<"m8n8k128", MatrixShape<8, 4, 32>>(),
                bit_rows_of_shape<"m16n8k128", MatrixShape<16, 4, 32>>(),
                bit_rows_of_shape<"m16n8k256", MatrixShape<16, 8, 32>>(), transpose_row());

}  // namespace

RowList tensor_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
