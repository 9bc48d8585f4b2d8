// Integer comparisons.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

constexpr OpRow kRows[] = {
    binary<uint32_t>("setp.eq.u32", Unit::Int, "True where a == b, unsigned.",
                     [](uint32_t a, uint32_t b) { return a == b; },
                     {{{1, 1}, 1}, {{1, 0xffff'ffff}, 0}, {{0xffff'ffff, 1}, 0}}),
    binary<uint32_t>("setp.ne.u32", Unit::Int, "True where a != b, unsigned.",
                     [](uint32_t a, uint32_t b) { return a != b; },
                     {{{1, 1}, 0}, {{1, 0xffff'ffff}, 1}, {{0xffff'ffff, 1}, 1}}),
    binary<uint32_t>("setp.lt.u32", Unit::Int, "True where a < b, unsigned.",
                     [](uint32_t a, uint32_t b) { return a < b; },
                     {{{1, 1}, 0}, {{1, 0xffff'ffff}, 1}, {{0xffff'ffff, 1}, 0}}),
    binary<uint32_t>("setp.le.u32", Unit::Int, "True where a <= b, unsigned.",
                     [](uint32_t a, uint32_t b) { return a <= b; },
                     {{{1, 1}, 1}, {{1, 0xffff'ffff}, 1}, {{0xffff'ffff, 1}, 0}}),
    binary<uint32_t>("setp.gt.u32", Unit::Int, "True where a > b, unsigned.",
                     [](uint32_t a, uint32_t b) { return a > b; },
                     {{{1, 1}, 0}, {{1, 0xffff'ffff}, 0}, {{0xffff'ffff, 1}, 1}}),
    binary<uint32_t>("setp.ge.u32", Unit::Int, "True where a >= b, unsigned.",
                     [](uint32_t a, uint32_t b) { return a >= b; },
                     {{{1, 1}, 1}, {{1, 0xffff'ffff}, 0}, {{0xffff'ffff, 1}, 1}}),
    binary<int32_t>("setp.eq.s32", Unit::Int, "True where a == b, signed.",
                    [](int32_t a, int32_t b) { return a == b; },
                    {{{1, 1}, 1}, {{1, 0xffff'ffff}, 0}, {{0xffff'ffff, 1}, 0}}),
    binary<int32_t>("setp.ne.s32", Unit::Int, "True where a != b, signed.",
                    [](int32_t a, int32_t b) { return a != b; },
                    {{{1, 1}, 0}, {{1, 0xffff'ffff}, 1}, {{0xffff'ffff, 1}, 1}}),
    binary<int32_t>("setp.lt.s32", Unit::Int, "True where a < b, signed.",
                    [](int32_t a, int32_t b) { return a < b; },
                    {{{1, 1}, 0}, {{1, 0xffff'ffff}, 0}, {{0xffff'ffff, 1}, 1}}),
    binary<int32_t>("setp.le.s32", Unit::Int, "True where a <= b, signed.",
                    [](int32_t a, int32_t b) { return a <= b; },
                    {{{1, 1}, 1}, {{1, 0xffff'ffff}, 0}, {{0xffff'ffff, 1}, 1}}),
    binary<int32_t>("setp.gt.s32", Unit::Int, "True where a > b, signed.",
                    [](int32_t a, int32_t b) { return a > b; },
                    {{{1, 1}, 0}, {{1, 0xffff'ffff}, 1}, {{0xffff'ffff, 1}, 0}}),
    binary<int32_t>("setp.ge.s32", Unit::Int, "True where a >= b, signed.",
                    [](int32_t a, int32_t b) { return a >= b; },
                    {{{1, 1}, 1}, {{1, 0xffff'ffff}, 1}, {{0xffff'ffff, 1}, 0}}),
    binary<uint64_t>("setp.eq.u64", Unit::Int, "True where a == b, unsigned.",
                     [](uint64_t a, uint64_t b) { return a == b; },
                     {{{1, 1}, 1}, {{1, ~0ull}, 0}, {{~0ull, 1}, 0}}),
    binary<uint64_t>("setp.ne.u64", Unit::Int, "True where a != b, unsigned.",
                     [](uint64_t a, uint64_t b) { return a != b; },
                     {{{1, 1}, 0}, {{1, ~0ull}, 1}, {{~0ull, 1}, 1}}),
    binary<uint64_t>("setp.lt.u64", Unit::Int, "True where a < b, unsigned.",
                     [](uint64_t a, uint64_t b) { return a < b; },
                     {{{1, 1}, 0}, {{1, ~0ull}, 1}, {{~0ull, 1}, 0}}),
    binary<uint64_t>("setp.le.u64", Unit::Int, "True where a <= b, unsigned.",
                     [](uint64_t a, uint64_t b) { return a <= b; },
                     {{{1, 1}, 1}, {{1, ~0ull}, 1}, {{~0ull, 1}, 0}}),
    binary<uint64_t>("setp.gt.u64", Unit::Int, "True where a > b, unsigned.",
                     [](uint64_t a, uint64_t b) { return a > b; },
                     {{{1, 1}, 0}, {{1, ~0ull}, 0}, {{~0ull, 1}, 1}}),
    binary<uint64_t>("setp.ge.u64", Unit::Int, "True where a >= b, unsigned.",
                     [](uint64_t a, uint64_t b) { return a >= b; },
                     {{{1, 1}, 1}, {{1, ~0ull}, 0}, {{~0ull, 1}, 1}}),
    binary<int64_t>("setp.eq.s64", Unit::Int, "True where a == b, signed.",
                    [](int64_t a, int64_t b) { return a == b; },
                    {{{1, 1}, 1}, {{1, ~0ull}, 0}, {{~0ull, 1}, 0}}),
    binary<int64_t>("setp.ne.s64", Unit::Int, "True where a != b, signed.",
                    [](int64_t a, int64_t b) { return a != b; },
                    {{{1, 1}, 0}, {{1, ~0ull}, 1}, {{~0ull, 1}, 1}}),
    binary<int64_t>("setp.lt.s64", Unit::Int, "True where a < b, signed.",
                    [](int64_t a, int64_t b) { return a < b; },
                    {{{1, 1}, 0}, {{1, ~0ull}, 0}, {{~0ull, 1}, 1}}),
    binary<int64_t>("setp.le.s64", Unit::Int, "True where a <= b, signed.",
                    [](int64_t a, int64_t b) { return a <= b; },
                    {{{1, 1}, 1}, {{1, ~0ull}, 0}, {{~0ull, 1}, 1}}),
    binary<int64_t>("setp.gt.s64", Unit::Int, "True where a > b, signed.",
                    [](int64_t a, int64_t b) { return a > b; },
                    {{{1, 1}, 0}, {{1, ~0ull}, 1}, {{~0ull, 1}, 0}}),
    binary<int64_t>("setp.ge.s64", Unit::Int, "True where a >= b, signed.",
                    [](int64_t a, int64_t b) { return a >= b; },
                    {{{1, 1}, 1}, {{1, ~0ull}, 1}, {{~0ull, 1}, 0}}),
};

}  // namespace

RowList compare_rows() {
  return {kRows, std::size(kRows)};
}

}  // namespace glint::isa::GLINT_ISA_PATH
