// Counts the triangles of a leaf.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "memsys/address_space.h"
#include "rtunit/structure/structure.h"
#include "rtunit/traversal/ray_path.h"

namespace glint::rt {

// Returns the number of triangles of a triangle leaf in memory, 1 or 2.
inline uint8_t triangles_of(const Fetch& leaf, const mem::AddressSpace& memory) {
  return load<TriangleLeaf>(memory.find(leaf.address, sizeof(TriangleLeaf))).count > 1 ? 2 : 1;
}

}  // namespace glint::rt
