// Decides when a ray reads a header or a descriptor before its next node.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/shortcuts/split_reads.h"

#include "rtunit/traversal/traversal.h"

namespace glint::rt {
namespace {

constexpr uint32_t kDescriptorBytes = 8, kNoLimit = ~0u;

bool has_descriptor(NodeKind kind) {
  return kind != NodeKind::Internal && kind != NodeKind::Instance;
}

}  // namespace

SplitReads::SplitReads(const Shortcuts& shortcuts, const mem::AddressSpace& memory, WarpBuffer& buffer,
                       TestPipelines& pipelines, RtStats& stats)
    : shortcuts_(shortcuts),
      memory_(memory),
      buffer_(buffer),
      stats_(stats),
      header_pipe_(pipelines.add({shortcuts.header_latency, 1, kNoLimit})),
      descriptor_pipe_(pipelines.add({shortcuts.descriptor_latency, 1, kNoLimit})),
      lanes_(buffer.size()) {
}

void SplitReads::entered(uint32_t slot, int lane, Cycle) {
  const LaneMask bit = LaneMask{1} << lane;
  Lanes& lanes = lanes_[slot];
  lanes.described &= ~bit;
  lanes.header &= ~bit;
  if (shortcuts_.fetch_headers && buffer_[slot].ray_of(lane).nodes_visited == 0) lanes.header |= bit;
}

bool SplitReads::detour(uint32_t slot, int lane, Cycle) {
  RayState& ray = buffer_[slot].ray_of(lane);
  if (ray.status != RayStatus::Traversing) return false;
  const Lanes& lanes = lanes_[slot];
  Fetch what = next_fetch(ray);
  const bool wants_header = lanes.header >> lane & 1;
  if (wants_header)
    what = {ray.base, sizeof(StructureHeader), NodeKind::Internal};
  else if (shortcuts_.fetch_descriptors && has_descriptor(what.kind) && !(lanes.described >> lane & 1))
    what.bytes = kDescriptorBytes;
  else
    return false;
  if (!memory_.find(what.address, what.bytes)) {
    break_off(ray);
    return false;
  }
  buffer_.want(slot, lane, what, wants_header ? header_pipe_ : descriptor_pipe_, this);
  return true;
}

void SplitReads::errand_started(uint32_t slot, int lane) {
  const LaneMask bit = LaneMask{1} << lane;
  Lanes& lanes = lanes_[slot];
  if (lanes.header & bit) {
    lanes.header &= ~bit;
    ++stats_.headers;
  } else {
    lanes.described |= bit;
    ++stats_.descriptors;
  }
}

void SplitReads::visited(const Visit& visit) {
  const LaneMask bit = LaneMask{1} << visit.lane;
  lanes_[visit.slot].described &= ~bit;
  const bool has_entered = visit.node.kind == NodeKind::Instance && visit.ray.bottom_stack_base >= 0;
  if (has_entered && shortcuts_.fetch_headers) lanes_[visit.slot].header |= bit;
}

}  // namespace glint::rt
