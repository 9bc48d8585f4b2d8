// Where the nodes and leaves of a tree lie in a structure's bytes: what encodings have in common.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>

#include "rtunit/node_format.h"

namespace glint::rt {

struct Layout {
  std::vector<uint32_t> block;  // of each node of the tree, from the header
  uint64_t bytes = 0;           // of the structure
};

// Depth first; the children of a node follow each other without gaps, leaves among internal nodes.
Layout mixed_layout(const BuildTree& tree, uint32_t node_bytes);

// Depth first, internal nodes packed; behind them the leaves, at multiples of their own 64 bytes. Internal children of a
// node follow each other without gaps, and so do its leaves.
Layout split_layout(const BuildTree& tree, uint32_t node_bytes);

// The structure's bytes with all leaves in place; header and internal nodes are zero.
std::vector<std::byte> bytes_with_leaves(const BuildTree& tree, const Layout& layout);

std::span<const uint32_t> children_of(const BuildTree& tree, const BuildTree::Node& node);
std::vector<Bounds> bounds_of_children(const BuildTree& tree, const BuildTree::Node& node);

}  // namespace glint::rt
