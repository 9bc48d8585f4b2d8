// Holds the rows of one op family, as its file hands them over.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string_view>

#include "isa/op_row.h"

namespace glint::isa {

struct RowList {
  const OpRow* rows = nullptr;
  size_t count = 0;
};

// Holds a chapter of the table: a title, a sentence, and the function that gives its rows.
struct FamilyEntry {
  std::string_view name;
  std::string_view doc;
  RowList (*rows)();
};

}  // namespace glint::isa
