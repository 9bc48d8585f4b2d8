// Double-precision arithmetic: IEEE 754, NaNs keep their payload.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {

RowList double_rows() {
  return {};
}

}  // namespace glint::isa::GLINT_ISA_PATH
