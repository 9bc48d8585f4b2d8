// The rows of one op family, as its file hands them over.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

#include "isa/op_row.h"

namespace glint::isa {

struct RowList {
  const OpRow* rows = nullptr;
  size_t count = 0;
};

}  // namespace glint::isa
