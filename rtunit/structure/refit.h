// Fits structures to geometry that has moved: the tree stays as it was built, and its boxes follow the
// leaves.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rtunit/structure/build.h"
#include "rtunit/structure/tree.h"

namespace glint::rt {

// Holds how a structure was built. Structures that may be fitted are built with it: build.h takes a place for
// it. Model: a fitted structure keeps the places of its nodes, the order of children in a node, its pairs of
// triangles and its treelets, as an update in place does.
struct KeptTree {
  BuildTree tree;                           // as the node format has arranged it, with the structure's leaves
  Placement placement;                      // of its nodes
  PolicyChoice<NodeFormat> format{"bvh6"};  // as BuildOptions::format
  StructureInfo info;                       // of the structure as it is now; without an address
  std::vector<uint32_t> stack_need;         // stack entries that each instance needs; empty in a bottom level
};

// Each function writes a fitted structure over `structure`, the bytes of the one that `kept` belongs to.
// Every box holds what is below it, as if it had been built. Returns "" then. Returns a clause that says why
// the tree cannot be kept, such as "triangle 7 of geometry 0 ...", and leaves everything as it was, when the
// input has other primitives than were built: then the structure has to be built anew.

// Fits a bottom level to the places where the vertices and boxes of its input are now. A triangle that has
// lost its area stays in its leaf, where no ray hits it. Throws UserError when an index is out of range.
std::string refit_bottom(KeptTree& kept, const BottomLevel& moved, std::span<std::byte> structure,
                         uint32_t threads = 1);
// Fits a top level to the transforms of its instances, and to the boxes of their bottom levels. The instances
// that were active have to be so, with bottom levels that need no more stack entries.
std::string refit_top(KeptTree& kept, std::span<const Instance> moved, std::span<const StructureInfo> bottoms,
                      std::span<std::byte> structure);

}  // namespace glint::rt
