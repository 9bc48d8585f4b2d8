// Arithmetic that hands a carry on: add.cc, addc, sub.cc, subc, mad.cc, madc.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {

RowList carry_rows() {
  return {};
}

}  // namespace glint::isa::GLINT_ISA_PATH
