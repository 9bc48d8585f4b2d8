// Finds what a visit has pushed, and has it arranged.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/unit/walk_order.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "rtunit/node_format.h"

namespace glint::rt {

void WalkOrder::visited(const Visit& visit) {
  RayState& ray = visit.ray;
  if (visit.pushed == 0 || visit.node.kind != NodeKind::Internal || ray.status != RayStatus::Traversing)
    return;
  const auto bottom = size_t(std::max<int>(ray.bottom_stack_base, 0)), end = size_t(ray.stack_size);
  if (!has_room(ray)) {
    ++stats_.without_room;
    return;
  }
  ++stats_.arranged;
  policy_->arrange({ray, visit.node, bottom, end - visit.pushed, end});
}

// build_top() proves that a stack has room for a walk depth first from the root. So a ray with that much room
// above its entries, and room for the children of one more node, may go on depth first from here whenever it
// must.
bool WalkOrder::has_room(const RayState& ray) const {
  const std::byte* header = memory_.find(ray.ray.structure, sizeof(StructureHeader));
  const uint32_t need =
      header ? load<uint32_t>(header + offsetof(StructureHeader, stack_need)) : kStackEntries;
  return uint64_t(ray.stack_size) + need + kMaxWidth <= kStackEntries;
}

}  // namespace glint::rt
