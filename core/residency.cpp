// Computes how many warps and blocks fit into a core, and what limits them.
// SPDX-License-Identifier: Apache-2.0
#include "core/residency.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <string_view>
#include <utility>

#include "exec/block.h"

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

uint32_t num_warp_slots(const Params& params, uint32_t places) {
  return places + (params.parking.make({})->is_used() ? params.parking_lot.warps : 0);
}

std::string_view name_of(Residency::Limit limit) {
  constexpr std::string_view kNames[] = {"warps", "registers", "blocks", "shared memory"};
  static_assert(std::size(kNames) == size_t(Residency::Limit::SharedMemory) + 1);
  return kNames[size_t(limit)];
}

Residency residency(const Params& params, const LaunchNeeds& needs) {
  using Limit = Residency::Limit;
  const std::pair<Limit, uint32_t> fits[] = {
      {Limit::Warps, params.warps / needs.warps},
      {Limit::Registers, params.registers / registers_per_warp(needs.registers) / needs.warps},
      {Limit::Blocks, needs.has_blocks ? params.blocks : kMaxWarps},
      {Limit::SharedMemory, needs.shared_bytes ? params.shared_bytes / needs.shared_bytes : kMaxWarps}};
  const auto least = *std::min_element(std::begin(fits), std::end(fits),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return {least.first, least.second, least.second * needs.warps};
}

void check(const Params& params, uint32_t num_registers, Diagnostics& diagnostics) {
  if (occupancy(params, num_registers) > 0) return;
  diagnostics.error({},
                    fmt::format("a warp of this pipeline needs {} registers ({} per lane), and a core has {}",
                                registers_per_warp(num_registers), num_registers, params.registers),
                    fmt::format("set core.registers to {} or more", registers_per_warp(num_registers)));
}

void check_block(const Params& params, uint32_t num_registers, uint64_t threads, uint32_t shared_bytes,
                 Diagnostics& diagnostics) {
  if (threads > exec::kMaxBlockThreads)
    diagnostics.error(
        {}, fmt::format("a block has {} threads, expected at most {}", threads, exec::kMaxBlockThreads));
  const uint64_t warps = (threads + kLanes - 1) / kLanes, fit = occupancy(params, num_registers);
  if (fit > 0 && warps > fit)
    diagnostics.error({}, fmt::format("a block has {} warps, and {} fit into a core", warps, fit),
                      "core.warps and core.registers limit them");
  if (shared_bytes > params.shared_bytes)
    diagnostics.error({},
                      fmt::format("a block needs {} bytes of shared memory, and a core has {}", shared_bytes,
                                  params.shared_bytes),
                      fmt::format("set core.shared_bytes to {} or more", shared_bytes));
}

}  // namespace glint::core
