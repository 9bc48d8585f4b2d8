// Integer arithmetic, logic, shifts and bit fields.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// Choice: PTX leaves division by zero to the machine; a quotient of all ones and the dividend as remainder.
inline int32_t quotient(int32_t a, int32_t b) {
  if (b == 0) return -1;
  return b == -1 ? int32_t(0u - uint32_t(a)) : a / b;  // the host traps on -2^31 / -1
}
inline int32_t remainder_of(int32_t a, int32_t b) {
  if (b == 0) return a;
  return b == -1 ? 0 : a % b;
}

// Sums of neighbouring fields of 1, 2, 4 bits, then all bytes by a product: no branch, no table.
inline uint32_t count_ones(uint32_t x) {
  x -= (x >> 1) & 0x5555'5555u;
  x = (x & 0x3333'3333u) + ((x >> 2) & 0x3333'3333u);
  x = (x + (x >> 4)) & 0x0f0f'0f0fu;
  return (x * 0x0101'0101u) >> 24;
}

// Position of the highest one, ~0 for 0: fill with ones below it, then count.
inline uint32_t highest_one(uint32_t x) {
  x |= x >> 1;
  x |= x >> 2;
  x |= x >> 4;
  x |= x >> 8;
  x |= x >> 16;
  return count_ones(x) - 1;
}

inline uint32_t reversed(uint32_t x) {
  x = ((x >> 1) & 0x5555'5555u) | ((x & 0x5555'5555u) << 1);
  x = ((x >> 2) & 0x3333'3333u) | ((x & 0x3333'3333u) << 2);
  x = ((x >> 4) & 0x0f0f'0f0fu) | ((x & 0x0f0f'0f0fu) << 4);
  x = ((x >> 8) & 0x00ff'00ffu) | ((x & 0x00ff'00ffu) << 8);
  return (x >> 16) | (x << 16);
}

// n ones at the low end, n >= 32: all.
inline uint32_t low_ones(uint32_t n) {
  return n > 31 ? ~0u : (1u << (n & 31)) - 1;
}

// PTX ISA, bfe and bfi: position and length are the low 8 bits of their operands.
inline uint32_t field(uint32_t a, uint32_t position, uint32_t length) {
  const uint32_t p = position & 0xff, n = length & 0xff;
  const uint32_t shifted = p > 31 ? 0u : a >> (p & 31);
  return shifted & low_ones(n);
}
inline uint32_t signed_field(uint32_t a, uint32_t position, uint32_t length) {
  const uint32_t p = position & 0xff, n = length & 0xff;
  const uint32_t last = p + n - 1;
  const uint32_t sign_at = last > 31 ? 31 : last;  // n = 0 makes no sign, below
  const uint32_t sign = n == 0 ? 0u : 0u - ((a >> (sign_at & 31)) & 1);
  const uint32_t from_a = p > 31 ? 0u : low_ones(n) & (~0u >> (p & 31));  // bits that exist in a
  return (field(a, position, length) & from_a) | (sign & ~from_a);
}
inline uint32_t inserted(uint32_t a, uint32_t b, uint32_t position, uint32_t length) {
  const uint32_t p = position & 0xff, n = length & 0xff;
  const uint32_t mask = p > 31 ? 0u : low_ones(n) << (p & 31);
  return (b & ~mask) | ((a << (p & 31)) & mask);
}

constexpr OpRow kRows[] = {
    binary<uint32_t>("add.u32", Unit::Int, "Adds, modulo 2^32.", [](uint32_t a, uint32_t b) { return a + b; },
                     {{{1, 2}, 3}, {{7, 0xffff'fff9}, 0}}),
    binary<uint32_t>("add.s32", Unit::Int, "Adds, modulo 2^32.", [](uint32_t a, uint32_t b) { return a + b; },
                     {{{1, 2}, 3}, {{7, 0xffff'fff9}, 0}}),
    binary<uint32_t>("sub.u32", Unit::Int, "Subtracts, modulo 2^32.",
                     [](uint32_t a, uint32_t b) { return a - b; }, {{{3, 2}, 1}, {{0, 1}, 0xffff'ffff}}),
    binary<uint32_t>("sub.s32", Unit::Int, "Subtracts, modulo 2^32.",
                     [](uint32_t a, uint32_t b) { return a - b; }, {{{3, 2}, 1}, {{0, 1}, 0xffff'ffff}}),
    binary<uint32_t>("mul.lo.u32", Unit::Int, "Low half of the product.",
                     [](uint32_t a, uint32_t b) { return a * b; }, {{{3, 5}, 15}, {{0x8000'0001, 2}, 2}}),
    binary<uint32_t>("mul.lo.s32", Unit::Int, "Low half of the product.",
                     [](uint32_t a, uint32_t b) { return a * b; }, {{{3, 5}, 15}, {{0x8000'0001, 2}, 2}}),
    binary<uint32_t>("mul.hi.u32", Unit::Int, "High half of the unsigned product.",
                     [](uint32_t a, uint32_t b) { return uint32_t(uint64_t(a) * b >> 32); },
                     {{{0x8000'0000, 4}, 2}, {{0xffff'ffff, 0xffff'ffff}, 0xffff'fffe}}),
    binary<int32_t>("mul.hi.s32", Unit::Int, "High half of the signed product.",
                    [](int32_t a, int32_t b) { return int32_t(int64_t(a) * b >> 32); },
                    {{{0x8000'0000, 4}, 0xffff'fffe}, {{0xffff'ffff, 0xffff'ffff}, 0}}),
    binary<uint32_t>("div.u32", Unit::IntDiv, "Quotient; a division by 0 gives all ones.",
                     [](uint32_t a, uint32_t b) { return b == 0 ? ~0u : a / b; },
                     {{{7, 2}, 3}, {{7, 0}, 0xffff'ffff}, {{0xffff'ffff, 1}, 0xffff'ffff}}),
    binary<uint32_t>("rem.u32", Unit::IntDiv, "Remainder; of a division by 0, the dividend.",
                     [](uint32_t a, uint32_t b) { return b == 0 ? a : a % b; },
                     {{{7, 2}, 1}, {{7, 0}, 7}, {{0xffff'ffff, 16}, 15}}),
    binary<int32_t>(
        "div.s32", Unit::IntDiv,
        "Quotient, towards 0; a division by 0 gives all ones, -2^31 by -1 gives -2^31.",
        [](int32_t a, int32_t b) { return quotient(a, b); },
        {{{0xffff'fff9, 2}, 0xffff'fffd}, {{7, 0}, 0xffff'ffff}, {{0x8000'0000, 0xffff'ffff}, 0x8000'0000}}),
    binary<int32_t>(
        "rem.s32", Unit::IntDiv,
        "Remainder with the sign of the dividend; of a division by 0, the dividend; of -2^31 by -1, 0.",
        [](int32_t a, int32_t b) { return remainder_of(a, b); },
        {{{0xffff'fff9, 2}, 0xffff'ffff}, {{7, 0}, 7}, {{0x8000'0000, 0xffff'ffff}, 0}}),
    binary<uint32_t>("min.u32", Unit::Int, "The smaller.",
                     [](uint32_t a, uint32_t b) { return a < b ? a : b; },
                     {{{1, 0xffff'ffff}, 1}, {{3, 2}, 2}}),
    binary<uint32_t>("max.u32", Unit::Int, "The larger.",
                     [](uint32_t a, uint32_t b) { return a > b ? a : b; },
                     {{{1, 0xffff'ffff}, 0xffff'ffff}, {{3, 2}, 3}}),
    binary<int32_t>("min.s32", Unit::Int, "The smaller.", [](int32_t a, int32_t b) { return a < b ? a : b; },
                    {{{1, 0xffff'ffff}, 0xffff'ffff}, {{3, 2}, 2}}),
    binary<int32_t>("max.s32", Unit::Int, "The larger.", [](int32_t a, int32_t b) { return a > b ? a : b; },
                    {{{1, 0xffff'ffff}, 1}, {{3, 2}, 3}}),
    unary<uint32_t>("neg.s32", Unit::Int, "Negates, modulo 2^32.", [](uint32_t a) { return 0u - a; },
                    {{{1}, 0xffff'ffff}, {{0x8000'0000}, 0x8000'0000}}),
    unary<uint32_t>("abs.s32", Unit::Int, "Magnitude, modulo 2^32.",
                    [](uint32_t a) { return int32_t(a) < 0 ? 0u - a : a; },
                    {{{0xffff'ffff}, 1}, {{0x8000'0000}, 0x8000'0000}}),
    binary<uint64_t>("add.u64", Unit::Int, "Adds, modulo 2^64.", [](uint64_t a, uint64_t b) { return a + b; },
                     {{{0xffff'ffff, 1}, 0x1'0000'0000}, {{~0ull, 1}, 0}}),
    binary<uint64_t>("sub.u64", Unit::Int, "Subtracts, modulo 2^64.",
                     [](uint64_t a, uint64_t b) { return a - b; },
                     {{{0x1'0000'0000, 1}, 0xffff'ffff}, {{0, 1}, ~0ull}}),
    binary<uint64_t>("mul.lo.u64", Unit::Int, "Low half of the product.",
                     [](uint64_t a, uint64_t b) { return a * b; },
                     {{{0x1'0000'0001, 3}, 0x3'0000'0003}, {{~0ull, ~0ull}, 1}}),
    binary<uint64_t>("add.s64", Unit::Int, "Adds, modulo 2^64.", [](uint64_t a, uint64_t b) { return a + b; },
                     {{{0xffff'ffff, 1}, 0x1'0000'0000}, {{~0ull, 1}, 0}}),
    binary<uint64_t>("sub.s64", Unit::Int, "Subtracts, modulo 2^64.",
                     [](uint64_t a, uint64_t b) { return a - b; },
                     {{{0x1'0000'0000, 1}, 0xffff'ffff}, {{0, 1}, ~0ull}}),
    binary<uint64_t>("mul.lo.s64", Unit::Int, "Low half of the product.",
                     [](uint64_t a, uint64_t b) { return a * b; },
                     {{{0x1'0000'0001, 3}, 0x3'0000'0003}, {{~0ull, ~0ull}, 1}}),
    value_op<uint32_t, uint32_t>("mul.wide.u32", Unit::Int, "Unsigned product, all 64 bits.",
                                 [](uint32_t a, uint32_t b) { return uint64_t(a) * b; },
                                 {{{0xffff'ffff, 2}, 0x1'ffff'fffe}, {{3, 5}, 15}}),
    value_op<int32_t, int32_t>(
        "mul.wide.s32", Unit::Int, "Signed product, all 64 bits.",
        [](int32_t a, int32_t b) { return int64_t(a) * b; },
        {{{0xffff'ffff, 2}, 0xffff'ffff'ffff'fffe}, {{0x8000'0000, 0x8000'0000}, 1ull << 62}}),
    ternary<uint32_t>("mad.lo.u32", Unit::Int, "Low half of the product, plus the third source.",
                      [](uint32_t a, uint32_t b, uint32_t c) { return a * b + c; },
                      {{{3, 5, 1}, 16}, {{0x8000'0000, 2, 7}, 7}}),
    ternary<uint32_t>("mad.lo.s32", Unit::Int, "Low half of the product, plus the third source.",
                      [](uint32_t a, uint32_t b, uint32_t c) { return a * b + c; },
                      {{{3, 5, 1}, 16}, {{0x8000'0000, 2, 7}, 7}}),
    value_op<uint32_t, uint32_t, uint64_t>(
        "mad.wide.u32", Unit::Int, "Unsigned product of 64 bits, plus a pair.",
        [](uint32_t a, uint32_t b, uint64_t c) { return uint64_t(a) * b + c; },
        {{{0xffff'ffff, 2, 2}, 0x2'0000'0000}, {{3, 5, ~0ull}, 14}}),
    value_op<int32_t, int32_t, uint64_t>(
        "mad.wide.s32", Unit::Int, "Signed product of 64 bits, plus a pair.",
        [](int32_t a, int32_t b, uint64_t c) { return uint64_t(int64_t(a) * b) + c; },
        {{{0xffff'ffff, 2, 2}, 0}, {{3, 5, ~0ull}, 14}}),
    binary<uint32_t>("and.b32", Unit::Int, "Bitwise and.", [](uint32_t a, uint32_t b) { return a & b; },
                     {{{0xff00, 0x0ff0}, 0x0f00}, {{0xffff'ffff, 0x8000'0000}, 0x8000'0000}}),
    binary<uint32_t>("or.b32", Unit::Int, "Bitwise or.", [](uint32_t a, uint32_t b) { return a | b; },
                     {{{0xff00, 0x0ff0}, 0xfff0}, {{0, 0x8000'0000}, 0x8000'0000}}),
    binary<uint32_t>("xor.b32", Unit::Int, "Bitwise exclusive or.",
                     [](uint32_t a, uint32_t b) { return a ^ b; },
                     {{{0xff00, 0x0ff0}, 0xf0f0}, {{0xffff'ffff, 0xffff'ffff}, 0}}),
    unary<uint32_t>("not.b32", Unit::Int, "Bitwise complement.", [](uint32_t a) { return ~a; },
                    {{{0}, 0xffff'ffff}, {{0xffff'ffff}, 0}}),
    binary<uint64_t>("and.b64", Unit::Int, "Bitwise and.", [](uint64_t a, uint64_t b) { return a & b; },
                     {{{0xff00, 0x0ff0}, 0x0f00}, {{~0ull, 1ull << 63}, 1ull << 63}}),
    binary<uint64_t>("or.b64", Unit::Int, "Bitwise or.", [](uint64_t a, uint64_t b) { return a | b; },
                     {{{0xff00, 0x0ff0}, 0xfff0}, {{0, 1ull << 63}, 1ull << 63}}),
    binary<uint64_t>("xor.b64", Unit::Int, "Bitwise exclusive or.",
                     [](uint64_t a, uint64_t b) { return a ^ b; },
                     {{{0xff00, 0x0ff0}, 0xf0f0}, {{~0ull, ~0ull}, 0}}),
    unary<uint64_t>("not.b64", Unit::Int, "Bitwise complement.", [](uint64_t a) { return ~a; },
                    {{{0}, ~0ull}, {{~0ull}, 0}}),
    value_op<uint32_t, uint32_t>(
        "shl.b32", Unit::Int, "Shifts left; a count of 32 or more gives 0.",
        [](uint32_t a, uint32_t n) { return n > 31 ? uint32_t{0} : uint32_t(a << (n & 31)); },
        {{{1, 31}, 0x8000'0000}, {{1, 32}, 0}, {{0xffff'ffff, 0xffff'ffff}, 0}}),
    value_op<uint32_t, uint32_t>(
        "shr.u32", Unit::Int, "Shifts right, zeros enter; a count of 32 or more gives 0.",
        [](uint32_t a, uint32_t n) { return n > 31 ? uint32_t{0} : uint32_t(a >> (n & 31)); },
        {{{0x8000'0000, 31}, 1}, {{0xffff'ffff, 32}, 0}}),
    value_op<int32_t, uint32_t>(
        "shr.s32", Unit::Int, "Shifts right, copies of the sign enter; a count of 32 or more gives the sign.",
        [](int32_t a, uint32_t n) { return int32_t(a >> (n > 31 ? 31 : n)); },
        {{{0x8000'0000, 31}, 0xffff'ffff}, {{0x8000'0000, 32}, 0xffff'ffff}, {{8, 2}, 2}}),
    value_op<uint64_t, uint32_t>(
        "shl.b64", Unit::Int, "Shifts left; a count of 64 or more gives 0.",
        [](uint64_t a, uint32_t n) { return n > 63 ? uint64_t{0} : uint64_t(a << (n & 63)); },
        {{{1, 63}, 1ull << 63}, {{1, 64}, 0}, {{~0ull, 0xffff'ffff}, 0}}),
    value_op<uint64_t, uint32_t>(
        "shr.u64", Unit::Int, "Shifts right, zeros enter; a count of 64 or more gives 0.",
        [](uint64_t a, uint32_t n) { return n > 63 ? uint64_t{0} : uint64_t(a >> (n & 63)); },
        {{{1ull << 63, 63}, 1}, {{~0ull, 64}, 0}}),
    value_op<int64_t, uint32_t>(
        "shr.s64", Unit::Int, "Shifts right, copies of the sign enter; a count of 64 or more gives the sign.",
        [](int64_t a, uint32_t n) { return int64_t(a >> (n > 63 ? 63 : n)); },
        {{{1ull << 63, 63}, ~0ull}, {{1ull << 63, 64}, ~0ull}, {{8, 2}, 2}}),
    unary<uint32_t>("popc.b32", Unit::Sfu, "Number of ones.", [](uint32_t a) { return count_ones(a); },
                    {{{0}, 0}, {{0xffff'ffff}, 32}, {{0x8000'0001}, 2}}),
    unary<uint32_t>("clz.b32", Unit::Sfu, "Number of leading zeros, 32 for 0.",
                    [](uint32_t a) { return 31u - highest_one(a); },
                    {{{0}, 32}, {{1}, 31}, {{0x8000'0000}, 0}}),
    unary<uint32_t>("brev.b32", Unit::Sfu, "Reverses the order of the bits.",
                    [](uint32_t a) { return reversed(a); },
                    {{{1}, 0x8000'0000}, {{0x0000'00f1}, 0x8f00'0000}}),
    unary<uint32_t>("bfind.u32", Unit::Sfu, "Position of the highest one, all ones for 0.",
                    [](uint32_t a) { return highest_one(a); },
                    {{{0}, 0xffff'ffff}, {{1}, 0}, {{0x8000'0000}, 31}}),
    unary<int32_t>(
        "bfind.s32", Unit::Sfu,
        "Position of the highest bit that differs from the sign, all ones if none does.",
        [](int32_t a) { return highest_one(uint32_t(a ^ (a >> 31))); },
        {{{0}, 0xffff'ffff}, {{0xffff'ffff}, 0xffff'ffff}, {{0x8000'0000}, 30}, {{0xffff'fffe}, 0}}),
    ternary<uint32_t>("bfe.u32", Unit::Int,
                      "Extracts a field: value, position, length (low 8 bits of each); zeros beyond.",
                      [](uint32_t a, uint32_t p, uint32_t n) { return field(a, p, n); },
                      {{{0x1234'5678, 8, 12}, 0x456},
                       {{0xffff'ffff, 28, 8}, 0xf},
                       {{0xffff'ffff, 0, 0}, 0},
                       {{0xffff'ffff, 40, 4}, 0}}),
    value_op<int32_t, uint32_t, uint32_t>(
        "bfe.s32", Unit::Int,
        "Extracts a field and extends its sign; the sign of a field past bit 31 is that bit.",
        [](int32_t a, uint32_t p, uint32_t n) { return signed_field(uint32_t(a), p, n); },
        {{{0x1234'8678, 8, 8}, 0xffff'ff86},
         {{0x7fff'ffff, 28, 8}, 7},
         {{0x8000'0000, 40, 4}, 0xffff'ffff},
         {{0xffff'ffff, 0, 0}, 0}}),
    value_op<uint32_t, uint32_t, uint32_t, uint32_t>(
        "bfi.b32", Unit::Int, "Inserts a field: field, background, position, length (low 8 bits of each).",
        [](uint32_t a, uint32_t b, uint32_t p, uint32_t n) { return inserted(a, b, p, n); },
        {{{0xab, 0x1111'1111, 8, 8}, 0x1111'ab11},
         {{0xff, 0, 28, 8}, 0xf000'0000},
         {{0xff, 5, 0, 0}, 5},
         {{0xff, 5, 32, 4}, 5}}),
};

}  // namespace

RowList integer_rows() {
  return {kRows, std::size(kRows)};
}

}  // namespace glint::isa::GLINT_ISA_PATH
