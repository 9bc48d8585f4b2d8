// Ops on predicates.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

constexpr OpRow kRows[] = {
    unary<bool>("mov.pred", Unit::Predicate, "Copies a predicate.", [](bool a) { return a; },
                {{{0}, 0}, {{1}, 1}}),
    unary<bool>("not.pred", Unit::Predicate, "Inverts a predicate.", [](bool a) { return !a; },
                {{{0}, 1}, {{1}, 0}}),
    binary<bool>("and.pred", Unit::Predicate, "True where both are.",
                 [](bool a, bool b) { return bool(a & b); }, {{{0, 1}, 0}, {{1, 0}, 0}, {{1, 1}, 1}}),
    binary<bool>("or.pred", Unit::Predicate, "True where one or both are.",
                 [](bool a, bool b) { return bool(a | b); }, {{{0, 0}, 0}, {{1, 0}, 1}, {{1, 1}, 1}}),
    binary<bool>("xor.pred", Unit::Predicate, "True where exactly one is.",
                 [](bool a, bool b) { return a != b; }, {{{0, 1}, 1}, {{1, 0}, 1}, {{1, 1}, 0}}),
};

}  // namespace

RowList predicate_rows() {
  return {kRows, std::size(kRows)};
}

}  // namespace glint::isa::GLINT_ISA_PATH
