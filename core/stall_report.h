// Says in words what the warps of a core wait for, for a machine that is stuck.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "core/memory_accesses.h"
#include "core/warp_slots.h"
#include "exec/image.h"

namespace glint::core {

// Returns one line for all warps that wait alike.
std::string describe_warps(const WarpSlots& warps, const MemoryAccesses& memory, const exec::World& world);

}  // namespace glint::core
