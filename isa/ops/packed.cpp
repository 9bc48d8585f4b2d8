// Bytes and half words of a register at once: video ops, dot products, pairs of 16-bit integers.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {

RowList packed_rows() {
  return {};
}

}  // namespace glint::isa::GLINT_ISA_PATH
