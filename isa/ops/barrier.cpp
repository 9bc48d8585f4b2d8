// Waiting for the other warps of the block, and ordering memory accesses.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {

RowList barrier_rows() {
  return {};
}

}  // namespace glint::isa::GLINT_ISA_PATH
