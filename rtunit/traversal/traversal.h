// Walks rays one node at a time by Vulkan's rules. The functional and the timing machine make the same steps.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>

#include "memsys/address_space.h"
#include "rtunit/structure/structure.h"
#include "rtunit/traversal/ray_state.h"

namespace glint::rt {

// Starts the ray in `state.ray` and resets everything else. Three kinds of rays end at once as a miss: those
// with a null structure, with a value that is infinite or not a number, and with an empty interval (Choice:
// Vulkan leaves them undefined). Returns false when `ray.structure` is not a top-level structure, which is
// the program's fault; the ray is then Done.
bool begin(RayState& state, const mem::AddressSpace& memory);

// Returns the node that step() must be given next. It may be called only while Traversing.
inline Fetch next_fetch(const RayState& state) {
  const NodeRef ref = state.stack[size_t(state.stack_size) - 1].node;
  const NodeKind kind = kind_of(ref);
  const uint32_t bytes = kind == NodeKind::Internal ? state.node_bytes : leaf_bytes(kind);
  return {state.base + Address(block_of(ref)) * kBlockBytes, bytes, kind};
}

// Returns the node that an entry of the ray's stack stands for. Entries below bottom_stack_base lie in the
// top-level structure.
inline Fetch fetch_of_entry(const RayState& state, size_t entry) {
  const NodeRef ref = state.stack[entry].node;
  const NodeKind kind = kind_of(ref);
  const Address base = int(entry) < state.bottom_stack_base ? state.ray.structure : state.base;
  const uint32_t bytes = kind == NodeKind::Internal ? state.node_bytes : leaf_bytes(kind);
  return {base + Address(block_of(ref)) * kBlockBytes, bytes, kind};
}

// Visits the node of next_fetch(). Afterwards the ray is Traversing, Done, Gathered or needs a shader.
void step(RayState& state, const std::byte* bytes);

// Names a node below an instance at which a ray may begin its walk. Addresses are virtual.
struct Start {
  Address instance_leaf = 0;
  Address node = 0;
  NodeKind kind = NodeKind::Internal;  // of the node
  bool operator==(const Start&) const = default;
};

// Makes a ray that has visited no node yet walk the subtree of a node first and then everything from the
// root. The primitives of the subtree are tested twice unless a hit among them ends the ray, which changes no
// hit. Returns false, and leaves the ray at the root, when the ray's mask or flags skip the instance or the
// node, when there is no such node, or when the ray's stack might not have room for one more entry.
bool start_at(RayState& state, const mem::AddressSpace& memory, const Start& start);

// Returns the node `levels` above the leaf that the ray has visited last and that holds `hit`: at most the
// root of the same bottom level. A ray that keeps no path has none. It is defined here, because policies are
// linked behind the other objects and can only call those that the machine needs anyway.
inline std::optional<Start> start_above(const RayState& state, const Hit& hit, uint32_t levels) {
  if (!state.path || state.path->depth == RayPath::kNoParent) return std::nullopt;
  size_t depth = state.path->depth;
  for (; levels && depth > 0 && state.path->node[depth - 1].kind != NodeKind::Instance; --levels) --depth;
  const Fetch& node = state.path->node[depth];
  return Start{hit.instance_leaf, node.address, node.kind};
}

// Ends a ray whose next node lies outside memory: it is Done and `broken`.
void break_off(RayState& state);

// Steps until the ray is Done, needs a shader, or has Gathered candidates and can go no further without
// shaders. The last happens when the traversal has ended or the table is full. Choice: a ray with a full
// table traverses on when all of the table has been decided.
void run(RayState& state, const mem::AddressSpace& memory);

// Takes a candidate of a Gathered ray out of its table. Its shader runs next.
inline void present(RayState& state, uint32_t row) {
  const Candidate& next = state.table->row[row];
  state.candidate = next.hit;
  state.candidate_procedural = next.is_procedural;
  state.candidate_opaque = next.is_opaque;
  state.candidate_row = uint8_t(row);
  state.status = next.is_procedural ? RayStatus::NeedsIntersection : RayStatus::NeedsAnyHit;
  state.table->used &= ~(1u << row);
}

// These are the answers of shaders. One of the first three ends NeedsAnyHit. NeedsIntersection takes any
// number of report() and then finish_intersection(); each report() that answers NeedsAnyHit is followed by
// one of the first three.
void accept_candidate(RayState& state);
void ignore_candidate(RayState& state);
void terminate_candidate(RayState& state);  // Accepts, and ends the traversal.

enum class Report : uint8_t {
  Rejected,     // The hit lies outside the interval, or the traversal is over.
  Accepted,     // The candidate is opaque: it is committed, and attribute_slot has flipped.
  NeedsAnyHit,  // The status is NeedsAnyHit until the candidate is decided, then NeedsIntersection again.
};
// Does reportIntersectionEXT(t, kind). It sets report_accepted, unless the answer is NeedsAnyHit: the
// decision sets it then.
Report report(RayState& state, float t, uint32_t kind);
void finish_intersection(RayState& state);

}  // namespace glint::rt
