// Rays that a shader walks itself, candidate by candidate.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {

RowList ray_query_rows() {
  return {};
}

}  // namespace glint::isa::GLINT_ISA_PATH
