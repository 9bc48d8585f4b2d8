// The order of the op families in the table; the same on every SIMD path.
// SPDX-License-Identifier: Apache-2.0
#include "isa/ops/families.h"

#include "isa/op_makers.h"

namespace glint::isa::GLINT_ISA_PATH {

void run_nothing(Warp&, const Inst&) {
}

RowList family_rows(int family) {
  constexpr RowList (*kFamilies[])() = {&move_rows,    &integer_rows,    &compare_rows, &float_rows,
                                        &convert_rows, &predicate_rows,  &memory_rows,  &texture_rows,
                                        &control_rows, &ray_tracing_rows};
  return kFamilies[family]();
}

}  // namespace glint::isa::GLINT_ISA_PATH
