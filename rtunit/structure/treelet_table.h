// Writes the table that says which nodes of a structure form a treelet.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "rtunit/tree_layout.h"
#include "rtunit/treelets.h"

namespace glint::rt {

// Describes the table of a structure whose nodes take the first `bytes`.
TreeletTable describe_treelets(const NodeOrder& order, uint32_t node_bytes, uint64_t bytes);

// Writes a table to `to`, which has room for its bytes.
void write_treelets(const TreeletTable& table, const BuildTree& tree, const NodeOrder& order,
                    const Placement& placement, std::byte* to);

}  // namespace glint::rt
