// Says which test checks what an op does.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

#include "isa/op_row.h"

namespace glint::isa {

// Returns the file of the test that executes the op and compares its result with an oracle: the examples of a
// value op, or the oracle of an effect. tests/ops/coverage_test.cpp runs these oracles on every row.
std::string_view test_of(const OpRow& row);

}  // namespace glint::isa
