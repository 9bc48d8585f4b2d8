// Says how many warps and blocks of a launch fit into a core, and what limits them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

#include "base/diagnostics.h"
#include "core/params.h"

namespace glint::core {

// Returns the number of warps that fit when each lane holds `num_registers` registers, or 0 when not even one
// does.
uint32_t occupancy(const Params& params, uint32_t num_registers);
// Returns the number of warps of a core that can have begun and not ended when `places` can run at a time.
uint32_t num_warp_slots(const Params& params, uint32_t places);

// Says what a launch asks of a core.
struct LaunchNeeds {
  uint32_t registers = 1;     // registers per lane
  uint32_t warps = 1;         // warps per block; 1 without blocks
  uint32_t shared_bytes = 0;  // bytes of shared memory per block
  bool has_blocks = false;
};
struct Residency {
  // Names the resource of a core that is used up first. When several are used up at once, it is the first of
  // them in this order.
  enum class Limit : uint8_t { Warps, Registers, Blocks, SharedMemory } limit = Limit::Warps;
  uint32_t blocks = 0, warps = 0;
};
std::string_view name_of(Residency::Limit limit);
Residency residency(const Params& params, const LaunchNeeds& needs);

// Reports a program that cannot run on such a core, or a block that does not fit.
void check(const Params& params, uint32_t num_registers, Diagnostics& diagnostics);
void check_block(const Params& params, uint32_t num_registers, uint64_t threads, uint32_t shared_bytes,
                 Diagnostics& diagnostics);

}  // namespace glint::core
