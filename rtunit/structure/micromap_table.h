// Writes the opacity micromaps of a bottom level, and says in its leaves where they are.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>

#include "rtunit/structure/leaves.h"

namespace glint::rt {

// Returns the table with its maps, which lies behind a structure's nodes; it is empty when no triangle of the
// bottom level has micromaps. Marks the leaves. Leaves with the same maps share them.
std::vector<std::byte> take_micromaps(const BottomLevel& input, Leaves& leaves);

}  // namespace glint::rt
