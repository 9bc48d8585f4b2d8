// Lanes that read each other: shuffles, votes, matches and reductions.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {

RowList warp_rows() {
  return {};
}

}  // namespace glint::isa::GLINT_ISA_PATH
