// Says how good a structure is, by the surface-area heuristic.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>
#include <span>

#include "base/types.h"

namespace glint::rt {

// Returns the number of internal nodes and leaves that a ray is expected to visit which meets the root's box
// and which nothing ends early: the sum over all of them of the area of their box over that of the root's
// (MacDonald and Booth 1990). Boxes are those that the traversal sees, and a leaf counts once. A leaf of a
// top level also counts what `below` says of its bottom level; without it nothing. `structure` holds the
// bytes of a structure of a registered format. A root without area counts as if each ray met everything.
double expected_visits(std::span<const std::byte> structure,
                       const std::function<double(Address)>& below = {});

}  // namespace glint::rt
