// Writes a structure from its leaves.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "rtunit/structure/build.h"
#include "rtunit/structure/leaves.h"

namespace glint::rt {

// Builds the tree over the leaves of a bottom level (0) or a top level (1), and encodes it. Throws UserError
// when a ray's stack cannot hold what the tree needs, or the structure is too large. With `kept`, it gets the
// tree.
EncodedStructure encode(const std::string& name, uint8_t level, Leaves leaves, const BuildOptions& options,
                        uint32_t threads, KeptTree* kept);

}  // namespace glint::rt
