// Turns the words that lanes give to a message into text in the launch's log.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "exec/warp_context.h"
#include "isa/op_row.h"

namespace glint::exec {

void run_print(const World& world, WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);

}  // namespace glint::exec
