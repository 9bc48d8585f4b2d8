// How many warps fit into a core's register file.
// SPDX-License-Identifier: Apache-2.0
#include "core/params.h"

#include <fmt/format.h>

#include <algorithm>

namespace glint::core {
namespace {

uint32_t registers_per_warp(uint32_t num_registers) {
  const uint32_t units = (std::max(num_registers, 1u) + kRegisterUnit - 1) / kRegisterUnit;
  return units * kRegisterUnit * uint32_t(kLanes);
}

}  // namespace

uint32_t occupancy(const Params& params, uint32_t num_registers) {
  return std::min(params.warps, params.registers / registers_per_warp(num_registers));
}

void check(const Params& params, uint32_t num_registers, Diagnostics& diagnostics) {
  if (occupancy(params, num_registers) > 0) return;
  diagnostics.error({}, fmt::format("a warp of this pipeline needs {} registers ({} a lane), a core has {}",
                                    registers_per_warp(num_registers), num_registers, params.registers),
                    fmt::format("set core.registers to {} or more", registers_per_warp(num_registers)));
}

}  // namespace glint::core
