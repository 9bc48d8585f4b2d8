// The row lists of the op families, as compiled for one SIMD path.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

#include "isa/op_row.h"

namespace glint::isa {

struct RowList {
  const OpRow* rows = nullptr;
  size_t count = 0;
};

namespace GLINT_ISA_PATH {

RowList move_rows();
RowList integer_rows();
RowList compare_rows();
RowList float_rows();
RowList convert_rows();
RowList predicate_rows();
RowList memory_rows();
RowList texture_rows();
RowList control_rows();
RowList ray_tracing_rows();

}  // namespace GLINT_ISA_PATH
}  // namespace glint::isa
