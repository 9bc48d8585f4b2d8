// Cuts blocks with many calls into several, because the installed optimiser's inliner moves the rest of a
// block once for each call in it, which takes time that grows with the square of the calls.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

namespace glint::frontend {

// Cuts after every `calls_of_block` calls. The optimiser joins the parts again after inlining. A block with a
// loop's merge instruction stays whole, because that instruction belongs to the block that the loop enters.
std::vector<uint32_t> with_short_blocks(std::vector<uint32_t> spirv, uint32_t calls_of_block);

}  // namespace glint::frontend
