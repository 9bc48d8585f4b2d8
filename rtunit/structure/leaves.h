// Turns the geometry of a bottom level into leaves.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rtunit/structure/build.h"
#include "rtunit/structure/build_tree.h"

namespace glint::rt {

// Holds the leaves of a structure, in the order of the input.
struct Leaves {
  mem::HostArray<BuildItem> items;
  mem::HostBlock bytes;              // of the leaves, without gaps
  std::vector<uint32_t> stack_need;  // stack entries needed below each instance; empty in a bottom level
  uint64_t primitives = 0;
  uint8_t contents = 0;              // as StructureHeader::contents
  std::vector<std::byte> micromaps;  // take_micromaps(); they follow the nodes
};

// Makes the leaves of a bottom level on up to `threads` threads. Throws UserError when an index is out of
// range.
Leaves leaves_of(const BottomLevel& input, bool pair_triangles, uint32_t threads);

}  // namespace glint::rt
