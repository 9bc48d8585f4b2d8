// Declares the row lists of the op families, as compiled for one SIMD path.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "isa/ops/row_list.h"

// The files of isa/ops/effects are compiled for the baseline path only. The machine does the work of their
// ops, so other paths would be no faster.
namespace glint::isa::baseline {
RowList atomic_rows();
RowList barrier_rows();
RowList async_rows();
RowList matrix_access_rows();
RowList texture_rows();
RowList surface_rows();
RowList control_rows();
RowList ray_tracing_rows();
RowList ray_query_rows();
RowList hit_object_rows();
RowList print_rows();
}  // namespace glint::isa::baseline

namespace glint::isa::GLINT_ISA_PATH {

RowList move_rows();
RowList integer_rows();
RowList bits_rows();
RowList fused_rows();
RowList packed_rows();
RowList carry_rows();
RowList compare_rows();
RowList compare_float_rows();
RowList float_rows();
RowList double_rows();
RowList half_rows();
RowList approximate_rows();
RowList convert_rows();
RowList convert_to_integer_rows();
RowList convert_from_integer_rows();
RowList convert_float_rows();
RowList convert_packed_rows();
RowList predicate_rows();
RowList memory_rows();
RowList warp_rows();
RowList tensor_rows();

}  // namespace glint::isa::GLINT_ISA_PATH
