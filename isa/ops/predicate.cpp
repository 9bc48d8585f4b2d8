// Defines ops on predicates.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// A predicate is already a mask, so the handler works on whole masks and not on lanes.
template <class F, size_t... N>
void run_masks(Warp& warp, const Inst& inst, std::index_sequence<N...>) {
  const LaneMask* const predicate = &warp.predicate.front();
  const Slot* const slot = &inst.operand.front();
  write_predicate(warp, slot[0], F{}(predicate[slot[N + 1]]...));
}
template <class F, size_t kSources>
void run_mask_op(Warp& warp, const Inst& inst, const OpRow&) {
  run_masks<F>(warp, inst, std::make_index_sequence<kSources>{});
}

template <size_t kSources, class F>
constexpr OpRow mask_op(std::string_view name, std::string_view doc, F, Examples examples) {
  OpRow row;
  row.name = name;
  row.unit = Unit::Predicate;
  row.operands = kSources == 1   ? Operands{DstPred, SrcPred}
                 : kSources == 2 ? Operands{DstPred, SrcPred, SrcPred}
                                 : Operands{DstPred, SrcPred, SrcPred, SrcPred};
  row.run = &run_mask_op<F, kSources>;
  row.doc = doc;
  row.examples = examples;
  return row;
}

constexpr OpRow kRows[] = {
    mask_op<1>("mov.pred", "Copies a predicate.", [](LaneMask a) { return a; }, {{{0}, 0}, {{1}, 1}}),
    mask_op<1>("not.pred", "Inverts a predicate.", [](LaneMask a) { return ~a; }, {{{0}, 1}, {{1}, 0}}),
    mask_op<2>("and.pred", "Gives true where both are true.", [](LaneMask a, LaneMask b) { return a & b; },
               {{{0, 1}, 0}, {{1, 0}, 0}, {{1, 1}, 1}}),
    mask_op<2>("or.pred", "Gives true where one or both are true.",
               [](LaneMask a, LaneMask b) { return a | b; }, {{{0, 0}, 0}, {{1, 0}, 1}, {{1, 1}, 1}}),
    mask_op<2>("xor.pred", "Gives true where exactly one is true.",
               [](LaneMask a, LaneMask b) { return a ^ b; }, {{{0, 1}, 1}, {{1, 0}, 1}, {{1, 1}, 0}}),
    mask_op<3>("selp.pred", "Returns the first source where the third is true, else the second.",
               [](LaneMask a, LaneMask b, LaneMask p) { return (a & p) | (b & ~p); },
               {{{1, 0, 1}, 1}, {{1, 0, 0}, 0}, {{0, 1, 0}, 1}}),
};

}  // namespace

RowList predicate_rows() {
  return {kRows, std::size(kRows)};
}

}  // namespace glint::isa::GLINT_ISA_PATH
