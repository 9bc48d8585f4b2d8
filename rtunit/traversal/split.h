// Splits the walk of a ray, so that another lane can visit a part of what the ray still has to visit.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

#include "memsys/address_space.h"
#include "rtunit/traversal/ray_state.h"

namespace glint::rt {

// Takes an entry off a ray's stack. `part` becomes the same ray with nothing but that entry to visit; what
// its storage held before does not matter. Afterwards the part is Traversing, or Done when the entry lies
// behind the hit. `from` must have a further entry above, and gathers no candidates.
void split_off(RayState& from, size_t entry, RayState& part);

// Adds to a ray what a part of it found and counted since the last call. Returns whether the ray has a nearer
// hit now. The nearest hit does not depend on the order of these calls.
bool merge_part(RayState& part, RayState& ray);

// Gives a part the ray's nearest hit so far, which shortens its walk.
inline void share_hit(const RayState& ray, RayState& part) {
  part.committed = ray.committed;
}

// Ends a ray, or a part of one, that looks for any hit and of which one has been found.
void cancel(RayState& state);

// Returns whether no shader can be needed for the ray, whatever it meets. Only such rays are split: a part
// cannot wait for a shader.
bool needs_no_shader(const RayState& state, const mem::AddressSpace& memory);

}  // namespace glint::rt
