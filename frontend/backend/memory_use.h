// Describes a memory access for searches for dependences.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "frontend/backend/slots.h"

namespace glint::frontend {

struct MemoryUse {
  bool any = false, writes = false, in_frame = false;
  isa::Space space = isa::Space::None;
  int64_t begin = 0, end = 0;  // byte range in the frame

  bool reads_constants() const { return any && (space == isa::Space::Const || space == isa::Space::Param); }
  // Returns true for loads from memory that threads write.
  bool is_load() const { return any && !writes && !reads_constants(); }
};

MemoryUse memory_use(const VirtualInst& inst);

bool must_stay_in_order(const MemoryUse& a, const MemoryUse& b);

}  // namespace glint::frontend
