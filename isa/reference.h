// The reference of the instruction set, written from the op table.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "isa/op_row.h"

namespace glint::isa {

// Every op by family: docs/isa.md.
std::string reference_markdown();

// One op for a terminal; UserError with the nearest name when there is no such op.
std::string describe_op(std::string_view name);

// "%r %r %rd": the operands of an op as the text writes them.
std::string operand_text(const OpRow& row);

}  // namespace glint::isa
