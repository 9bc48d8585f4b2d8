// Floats of 16 bits: f16, bf16, and pairs of them.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {

RowList half_rows() {
  return {};
}

}  // namespace glint::isa::GLINT_ISA_PATH
