// Moves threads between the warps of a core while these wait at the same place.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "exec/warp_context.h"

namespace glint::exec {

// Returns whether threads of the two warps may change places: both warps are at the same instruction, of the
// same traces and calls, and their lanes meet at the same places. Neither warp may have rays or accesses
// under way.
bool can_exchange(const WarpContext& a, const WarpContext& b);

// Returns the lanes whose threads may leave the warp: those that run, those that wait to be met, and those
// without a thread. The others wait on a path of their own, which other warps need not have.
LaneMask movable_lanes(const WarpContext& warp);

// Lets the threads in lane `i` of warp `a` and in lane `j` of warp `b` change places, with all that belongs
// to them: registers, stack, rays and callables under way, hit objects, queries, who they are, and where they
// wait. What belongs to a lane stays: its number and its masks. The warps may be exchanged, and the lanes
// movable.
void swap_threads(WarpContext& a, int i, WarpContext& b, int j, const Image& image);

}  // namespace glint::exec
