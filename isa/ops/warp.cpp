// Defines ops in which lanes read each other: shuffles, votes, matches and reductions.
// SPDX-License-Identifier: Apache-2.0
//
// Their last operand is the member mask. The lanes that take part with a lane are the lanes of its mask that
// execute the instruction with the same mask. Choice: a lane outside its own mask takes part with no lane and
// still gets a result, which PTX leaves open.
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// Returns the lanes of a row that hold a value. It uses intrinsics, because compilers add up the bits and do
// not move the mask.
[[gnu::always_inline]] inline LaneMask lanes_equal(const uint32_t* row, uint32_t value) {
#if defined(__AVX512F__)
  const __m512i wanted = _mm512_set1_epi32(int(value));
  const uint32_t low = _mm512_cmpeq_epi32_mask(_mm512_loadu_si512(row), wanted);
  const uint32_t high = _mm512_cmpeq_epi32_mask(_mm512_loadu_si512(row + 16), wanted);
  return low | high << 16;
#elif defined(__AVX2__)
  const __m256i wanted = _mm256_set1_epi32(int(value));
  LaneMask mask = 0;
  for (int i = 0; i < kLanes; i += 8) {
    const __m256i same =
        _mm256_cmpeq_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(row + i)), wanted);
    mask |= uint32_t(_mm256_movemask_ps(_mm256_castsi256_ps(same))) << i;
  }
  return mask;
#else
  return mask_of([&](int i) { return row[i] == value; });
#endif
}

// Writes for each lane the word of the lane that `from` (below 32) names.
[[gnu::always_inline]] inline void read_lanes(const uint32_t* row, const uint32_t* from, uint32_t* out) {
#if defined(__AVX512F__)
  const __m512i low = _mm512_loadu_si512(row), high = _mm512_loadu_si512(row + 16);
  for (int i = 0; i < kLanes; i += 16)
    _mm512_store_si512(out + i, _mm512_permutex2var_epi32(low, _mm512_load_si512(from + i), high));
#else
  all_lanes([&](int i) { out[i] = row[from[i]]; });
#endif
}

// Calls `visit(group, members)` for each different mask in row `masks`: the executing lanes that gave it, and
// those of them that it names. There is mostly one mask.
template <class Visit>
[[gnu::always_inline]] inline void each_group(const Warp& warp, const Source<uint32_t>& masks,
                                              Visit&& visit) {
  for (LaneMask rest = warp.exec; rest;) {
    const uint32_t mask = masks.at(__builtin_ctz(rest));
    const LaneMask group = lanes_equal(masks.low, mask) & rest;
    // Mostly all lanes give one mask. A prediction then lets the code after it start before the mask is
    // known.
    if (group == rest) [[likely]] {
      LaneMask all = rest;
      asm("" : "+r"(all));
      visit(all, all & mask);
      return;
    }
    visit(group, group & mask);
    rest &= ~group;
  }
}

// Writes one value to a register or predicate for the lanes of `group`.
[[gnu::always_inline]] inline void broadcast(Warp& warp, Slot slot, LaneMask group, uint32_t value) {
  uint32_t* const row = warp.bank[0] + slot * kLanes;
  all_lanes([&](int i) { row[i] = (group & kLaneBit[i]) != 0 ? value : row[i]; });
}
[[gnu::always_inline]] inline void set_predicate(Warp& warp, Slot slot, LaneMask group, bool value) {
  LaneMask& out = *(&warp.predicate.front() + slot);
  out = value ? out | group : out & ~group;
}
[[gnu::always_inline]] inline Slot slot_at(const Inst& inst, int n) {
  return *(&inst.operand.front() + n);
}

// Follows PTX's pseudocode: reads a lane or, outside the segment, the lane itself. Choice: of a lane that
// does not execute, the register is read as it is, which PTX leaves open.
enum class Shuffle { Up, Down, Butterfly, Index };
template <Shuffle kMode>
[[gnu::flatten]] void shuffle(Warp& warp, const Inst& inst, const OpRow&) {
  const Source<uint32_t> a(warp, slot_at(inst, 2)), b(warp, slot_at(inst, 3)), c(warp, slot_at(inst, 4));
  struct Source32 {
    uint32_t lane, inside;  // inside: 1 when the lane is in the segment
  };
  const auto source = [&](int i) -> Source32 {
    const int distance = int(b.at(i) & 31), clamp = int(c.at(i) & 31), segment = int(c.at(i) >> 8 & 31);
    const int first = i & segment, last = first | (clamp & ~segment);
    const int j = kMode == Shuffle::Up          ? i - distance
                  : kMode == Shuffle::Down      ? i + distance
                  : kMode == Shuffle::Butterfly ? i ^ distance
                                                : first | (distance & ~segment);
    const bool inside = kMode == Shuffle::Up ? j >= last : j <= last;
    // A clamp below the lane's segment may name a lane past the warp, which wraps.
    return {uint32_t(inside ? j : i) & 31, inside};
  };
  alignas(64) uint32_t from[kLanes], value[kLanes];
  all_lanes([&](int i) { from[i] = source(i).lane; });
  const LaneMask inside = mask_of([&](int i) { return source(i).inside != 0; });
  read_lanes(a.low, from, value);
  write_predicate(warp, slot_at(inst, 1), inside);
  write_lanes<uint32_t>(warp, slot_at(inst, 0), [&](int i) { return value[i]; });
}

enum class Vote { All, Any, Uniform };
template <Vote kVote>
[[gnu::flatten]] void vote(Warp& warp, const Inst& inst, const OpRow&) {
  const Source<bool> a(warp, slot_at(inst, 1));
  const Source<uint32_t> masks(warp, slot_at(inst, 2));
  const LaneMask votes = a.mask;
  each_group(warp, masks, [&](LaneMask group, LaneMask members) {
    const bool all = (votes & members) == members, any = (votes & members) != 0;
    set_predicate(warp, slot_at(inst, 0), group,
                  kVote == Vote::All   ? all
                  : kVote == Vote::Any ? any
                                       : all | !any);
  });
}
[[gnu::flatten]] void ballot(Warp& warp, const Inst& inst, const OpRow&) {
  const Source<bool> a(warp, slot_at(inst, 1));
  uint32_t result[kLanes]{};  // separate, because the destination may be the masks
  const Source<uint32_t> masks(warp, slot_at(inst, 2));
  each_group(warp, masks, [&](LaneMask group, LaneMask members) {
    all_lanes([&](int i) { result[i] = (group & kLaneBit[i]) != 0 ? a.mask & members : result[i]; });
  });
  write_lanes<uint32_t>(warp, slot_at(inst, 0), [&](int i) { return result[i]; });
}

// Returns for each lane the lanes with its value, whether they execute or not.
template <class T>
[[gnu::always_inline]] inline void lanes_of_values(const Source<T>& a, LaneMask* out) {
#if defined(__AVX512F__)
  // Words that differ leave bits after the exclusive or. They are packed to 16 bits, where non-zero values
  // stay non-zero, so that one test of 32 lanes makes a mask. The time is that of these instructions, of
  // which one or two execute per cycle. Packing takes four lanes in turn from either source.
  const __m512i fours = _mm512_setr_epi64(0, 1, 4, 5, 8, 9, 12, 13),
                others = _mm512_setr_epi64(2, 3, 6, 7, 10, 11, 14, 15);
  const auto dealt = [](const uint32_t* row, __m512i which) {
    return _mm512_permutex2var_epi64(_mm512_loadu_si512(row), which, _mm512_loadu_si512(row + 16));
  };
  const uint32_t* const upper = sizeof(T) == 8 ? a.high : a.low;
  const __m512i low[] = {dealt(a.low, fours), dealt(a.low, others)},
                high[] = {dealt(upper, fours), dealt(upper, others)};
  for (int k = 0; k < kLanes; ++k) {
    const __m512i wanted = _mm512_set1_epi32(int(a.low[k])), wanted_high = _mm512_set1_epi32(int(upper[k]));
    __m512i different[2];
    for (int h = 0; h < 2; ++h) {
      different[h] = _mm512_xor_si512(low[h], wanted);
      if constexpr (sizeof(T) == 8)  // different | (high ^ wanted_high)
        different[h] = _mm512_ternarylogic_epi32(different[h], high[h], wanted_high, 0xf6);
    }
    const __m512i packed = _mm512_packs_epi32(different[0], different[1]);
    out[k] = _mm512_testn_epi16_mask(packed, packed);
  }
#else
  for (int k = 0; k < kLanes; ++k) {
    out[k] = lanes_equal(a.low, a.low[k]);
    if constexpr (sizeof(T) == 8) out[k] &= lanes_equal(a.high, a.high[k]);
  }
#endif
}
// Returns for each lane the members with its value.
template <class T>
[[gnu::flatten]] void match_any(Warp& warp, const Inst& inst, const OpRow&) {
  const Source<T> a(warp, slot_at(inst, 1));
  const Source<uint32_t> masks(warp, slot_at(inst, 2));
  alignas(64) LaneMask result[kLanes], members_of[kLanes]{};
  lanes_of_values(a, result);
  each_group(warp, masks, [&](LaneMask group, LaneMask members) {
    all_lanes([&](int i) { members_of[i] = (group & kLaneBit[i]) != 0 ? members : members_of[i]; });
  });
  write_lanes<uint32_t>(warp, slot_at(inst, 0), [&](int i) { return result[i] & members_of[i]; });
}
// Returns the members and true if all have one value, and otherwise no lanes and false.
template <class T>
[[gnu::flatten]] void match_all(Warp& warp, const Inst& inst, const OpRow&) {
  const Source<T> a(warp, slot_at(inst, 2));
  const Source<uint32_t> masks(warp, slot_at(inst, 3));
  uint32_t result[kLanes]{};
  LaneMask matched = 0;
  each_group(warp, masks, [&](LaneMask group, LaneMask members) {
    const T value = a.at(__builtin_ctz(members ? members : group));
    LaneMask equal = lanes_equal(a.low, uint32_t(value));
    if constexpr (sizeof(T) == 8) equal &= lanes_equal(a.high, uint32_t(value >> 32));
    const bool same = (equal & members) == members;
    all_lanes([&](int i) { result[i] = (group & kLaneBit[i]) != 0 && same ? members : result[i]; });
    matched |= same ? group : 0;
  });
  write_lanes<uint32_t>(warp, slot_at(inst, 0), [&](int i) { return result[i]; });
  write_predicate(warp, slot_at(inst, 1), matched);
}

// Combines neighbours that lie kHalf apart until one value is left. Vectors halve in length each time.
template <int kHalf, class F, class T>
[[gnu::always_inline]] inline T folded(T* value) {
#if defined(__AVX512F__)
  static_assert(kHalf == 16);
  typedef T Row __attribute__((vector_size(64)));
  // The masked forms are used, because g++ 12 warns of its own unmasked forms (GCC bug 105593).
  constexpr __mmask8 kAll64 = 0xff;
  constexpr __mmask16 kAll32 = 0xffff;
  const auto row = [](__m512i x) { return __builtin_bit_cast(Row, x); };
  const auto words = [](Row x) { return __builtin_bit_cast(__m512i, x); };
  Row x = F{}(row(_mm512_load_si512(value)), row(_mm512_load_si512(value + kHalf)));
  x = F{}(x, row(_mm512_maskz_shuffle_i64x2(kAll64, words(x), words(x), 0x4e)));
  x = F{}(x, row(_mm512_maskz_shuffle_i64x2(kAll64, words(x), words(x), 0xb1)));
  x = F{}(x, row(_mm512_maskz_shuffle_epi32(kAll32, words(x), _MM_PERM_BADC)));
  x = F{}(x, row(_mm512_maskz_shuffle_epi32(kAll32, words(x), _MM_PERM_CDAB)));
  return x[0];
#else
  for (int i = 0; i < kHalf; ++i) value[i] = F{}(value[i], value[i + kHalf]);
  if constexpr (kHalf > 1) return folded<kHalf / 2, F>(value);
  return value[0];
#endif
}
// Combines the members' values. The neutral value stands for the other lanes.
template <class T, T kNeutral, class F>
[[gnu::flatten]] void reduce(Warp& warp, const Inst& inst, const OpRow&) {
  const Source<T> a(warp, slot_at(inst, 1));
  const Source<uint32_t> masks(warp, slot_at(inst, 2));
  uint32_t result[kLanes]{};
  each_group(warp, masks, [&](LaneMask group, LaneMask members) {
    alignas(64) T value[kLanes];
    all_lanes([&](int i) { value[i] = (members & kLaneBit[i]) != 0 ? a.at(i) : kNeutral; });
    const uint32_t all = uint32_t(folded<kLanes / 2, F>(value));
    all_lanes([&](int i) { result[i] = (group & kLaneBit[i]) != 0 ? all : result[i]; });
  });
  write_lanes<uint32_t>(warp, slot_at(inst, 0), [&](int i) { return result[i]; });
}

void active_mask(Warp& warp, const Inst& inst, const OpRow&) {
  broadcast(warp, slot_at(inst, 0), warp.exec, warp.exec);
}
// Returns the lowest member, and whether it is the lane itself.
[[gnu::flatten]] void elect(Warp& warp, const Inst& inst, const OpRow&) {
  const Source<uint32_t> masks(warp, slot_at(inst, 2));
  uint32_t result[kLanes]{};
  LaneMask leaders = 0;
  each_group(warp, masks, [&](LaneMask group, LaneMask members) {
    const uint32_t leader = members ? uint32_t(__builtin_ctz(members)) : 0;
    leaders |= members & (0u - members);
    all_lanes([&](int i) { result[i] = (group & kLaneBit[i]) != 0 ? leader : result[i]; });
  });
  write_lanes<uint32_t>(warp, slot_at(inst, 0), [&](int i) { return result[i]; });
  write_predicate(warp, slot_at(inst, 1), leaders);
}

constexpr OpRow row(std::string_view name, Operands operands, Handler run, std::string_view doc,
                    Examples examples) {
  OpRow out = effect_op(name, Class::Alu, Unit::Shuffle, Effect::None, operands, doc);
  out.run = run;
  out.examples = examples;
  return out;
}
constexpr OpRow shuffle_row(std::string_view name, Handler run, std::string_view doc) {
  // In these examples all lanes hold one value, so any source lane gives the same result.
  return row(name, {Dst32, DstPred, Src32, Src32, Src32, Src32}, run, doc,
             {{{7, 0, 31, ~0u}, 7, 1}, {{0x8000'0000, 0, 31, ~0u}, 0x8000'0000, 1}});
}
template <class T, T kNeutral, class F>
constexpr OpRow reduction(std::string_view name, std::string_view doc, F, Examples examples) {
  return row(name, {Dst32, Src32, Src32}, &reduce<T, kNeutral, F>, doc, examples);
}
constexpr Operands kVote{DstPred, SrcPred, Src32};

constexpr OpRow kRows[] = {
    row("shfl.sync.up.b32", {Dst32, DstPred, Src32, Src32, Src32, Src32}, &shuffle<Shuffle::Up>,
        "Reads the lane b below, and tells whether it is in the segment that c describes.",
        {{{7, 0, 0, ~0u}, 7, 1}, {{0x8000'0000, 0, 0, ~0u}, 0x8000'0000, 1}}),
    shuffle_row("shfl.sync.down.b32", &shuffle<Shuffle::Down>,
                "Reads the lane b above, and tells whether it is in the segment that c describes."),
    shuffle_row("shfl.sync.bfly.b32", &shuffle<Shuffle::Butterfly>,
                "Reads the lane whose number differs in the bits b, and tells whether it is in the segment."),
    shuffle_row("shfl.sync.idx.b32", &shuffle<Shuffle::Index>,
                "Reads lane b of the segment that c describes, and tells whether there is one."),
    row("vote.sync.all.pred", kVote, &vote<Vote::All>,
        "Tells whether the predicate is true for all lanes of the mask.", {{{1, ~0u}, 1}, {{0, ~0u}, 0}}),
    row("vote.sync.any.pred", kVote, &vote<Vote::Any>,
        "Tells whether the predicate is true for any lane of the mask.", {{{1, ~0u}, 1}, {{0, ~0u}, 0}}),
    row("vote.sync.uni.pred", kVote, &vote<Vote::Uniform>,
        "Tells whether the predicate is the same for all lanes of the mask.", {{{1, ~0u}, 1}, {{0, ~0u}, 1}}),
    row("vote.sync.ballot.b32", {Dst32, SrcPred, Src32}, &ballot,
        "Returns the lanes of the mask whose predicate is true.", {{{1, 5}, 5}, {{0, 5}, 0}}),
    row("match.any.sync.b32", {Dst32, Src32, Src32}, &match_any<uint32_t>,
        "Returns the lanes of the mask with the same value.", {{{9, 7}, 7}, {{0, 2}, 2}}),
    row("match.any.sync.b64", {Dst32, Src64, Src32}, &match_any<uint64_t>,
        "Returns the lanes of the mask with the same value.", {{{9, 7}, 7}, {{0x1'0000'0000, 2}, 2}}),
    row("match.all.sync.b32", {Dst32, DstPred, Src32, Src32}, &match_all<uint32_t>,
        "Returns the lanes of the mask and true if all have the same value, otherwise 0 and false.",
        {{{9, 7}, 7, 1}, {{0, 2}, 2, 1}}),
    row("match.all.sync.b64", {Dst32, DstPred, Src64, Src32}, &match_all<uint64_t>,
        "Returns the lanes of the mask and true if all have the same value, otherwise 0 and false.",
        {{{9, 7}, 7, 1}, {{0x1'0000'0000, 2}, 2, 1}}),
    reduction<uint32_t, 0>("redux.sync.add.u32", "Returns the sum over the lanes of the mask.",
                           [](auto a, auto b) { return a + b; },
                           {{{5, 3}, 10}, {{0x8000'0001, 7}, 0x8000'0003}}),
    reduction<uint32_t, 0>("redux.sync.add.s32", "Returns the sum over the lanes of the mask.",
                           [](auto a, auto b) { return a + b; },
                           {{{5, 3}, 10}, {{0xffff'ffff, 7}, 0xffff'fffd}}),
    reduction<uint32_t, ~0u>("redux.sync.min.u32", "Returns the minimum over the lanes of the mask.",
                             [](auto a, auto b) { return a < b ? a : b; },
                             {{{5, 3}, 5}, {{0xffff'ffff, 7}, 0xffff'ffff}}),
    reduction<int32_t, 0x7fff'ffff>(
        "redux.sync.min.s32", "Returns the signed minimum over the lanes of the mask.",
        [](auto a, auto b) { return a < b ? a : b; }, {{{5, 3}, 5}, {{0xffff'ffff, 7}, 0xffff'ffff}}),
    reduction<uint32_t, 0>("redux.sync.max.u32", "Returns the maximum over the lanes of the mask.",
                           [](auto a, auto b) { return a > b ? a : b; },
                           {{{5, 3}, 5}, {{0xffff'ffff, 7}, 0xffff'ffff}}),
    reduction<int32_t, -0x7fff'ffff - 1>(
        "redux.sync.max.s32", "Returns the signed maximum over the lanes of the mask.",
        [](auto a, auto b) { return a > b ? a : b; }, {{{5, 3}, 5}, {{0xffff'ffff, 7}, 0xffff'ffff}}),
    reduction<uint32_t, ~0u>("redux.sync.and.b32", "Returns the bitwise and over the lanes of the mask.",
                             [](auto a, auto b) { return a & b; }, {{{5, 3}, 5}, {{0, 7}, 0}}),
    reduction<uint32_t, 0>("redux.sync.or.b32", "Returns the bitwise or over the lanes of the mask.",
                           [](auto a, auto b) { return a | b; }, {{{5, 3}, 5}, {{0, 7}, 0}}),
    reduction<uint32_t, 0>("redux.sync.xor.b32",
                           "Returns the bitwise exclusive or over the lanes of the mask.",
                           [](auto a, auto b) { return a ^ b; }, {{{5, 3}, 0}, {{5, 7}, 5}}),
    // No example holds for every warp, because the executing lanes are not among the operands.
    row("activemask.b32", {Dst32}, &active_mask, "Returns the lanes that execute this instruction.", {}),
    // The second result differs from lane to lane: it is true in the lane that the first result names.
    row("elect.sync", {Dst32, DstPred, Src32}, &elect,
        "Returns the lowest lane of the mask, and tells whether it is this lane.", {{{7}, 0}, {{6}, 1}}),
};

}  // namespace

RowList warp_rows() {
  return {kRows, std::size(kRows)};
}

}  // namespace glint::isa::GLINT_ISA_PATH
