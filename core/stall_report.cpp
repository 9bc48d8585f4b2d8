// Says in words what the warps of a core wait for.
// SPDX-License-Identifier: Apache-2.0
#include "core/stall_report.h"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <utility>
#include <vector>

#include "exec/fault.h"

namespace glint::core {
namespace {

// Says where the warp is, what it waits for, and who can end the wait: the warps of its block, or whoever
// writes what it has read last.
std::string describe_warp(const WarpSlot& slot, uint32_t accesses, const exec::World& world) {
  const exec::WarpContext& warp = slot.warp;
  const NextIssue next = slot.scheduler->next_of(slot.local);
  std::string out =
      fmt::format("at {}, waits for {} {}, {} accesses in flight",
                  warp.simt.finished() ? "its end" : world.image->place_of(warp.simt.pc), name_of(next.wait),
                  next.ready_at == kNever ? std::string("without a known end")
                                          : fmt::format("until cycle {}", next.ready_at),
                  accesses);
  if (warp.waiting_at_barrier) {
    std::vector<uint64_t> missing;
    const exec::Block& block = slot.home->block;
    for (uint32_t w = 0; w < block.num_warps(); ++w)
      if ((block.live() & ~block.waiting()) >> w & 1) missing.push_back(block.warps[w]->warp_index);
    out += fmt::format(", at barrier {} for warps {}", warp.barrier, fmt::join(missing, ", "));
  } else if (!warp.simt.finished() && warp.simt.active != 0) {
    const Address address = warp.regs.access.address[size_t(std::countr_zero(warp.simt.active))];
    if (world.memory->find(address, 1))
      out += ", last access: " + exec::whereabouts(*world.memory, address, 1);
  }
  return out;
}

}  // namespace

std::string describe_warps(const WarpSlots& warps, const MemoryAccesses& memory, const exec::World& world) {
  // Groups the warps by what is said about them. Each text comes with its warps.
  std::vector<std::pair<std::string, std::vector<uint64_t>>> groups;
  for (uint32_t slot = 0; slot < warps.size(); ++slot) {
    if (!warps.is_resident(slot)) continue;
    std::string text = describe_warp(warps[slot], memory.in_flight(slot), world);
    const auto same =
        std::find_if(groups.begin(), groups.end(), [&](const auto& group) { return group.first == text; });
    if (same == groups.end())
      groups.push_back({std::move(text), {warps[slot].warp.warp_index}});
    else
      same->second.push_back(warps[slot].warp.warp_index);
  }
  std::string out;
  for (const auto& [text, indices] : groups)
    out += fmt::format("  warp{} {}: {}\n", indices.size() > 1 ? "s" : "", fmt::join(indices, ", "), text);
  return out;
}

}  // namespace glint::core
