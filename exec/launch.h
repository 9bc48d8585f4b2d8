// Says how many blocks and warps a launch has and which threads they hold, and starts them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "exec/warp_context.h"

namespace glint::exec {

// Says where a machine has put a warp, as the warp's program may ask with %warpid, %nwarpid, %smid and
// %nsmid.
struct Seat {
  uint32_t slot = 0, slots = 1;  // the warp slot of the core, and how many slots the core has
  uint32_t core = 0, cores = 1;
};

uint32_t num_blocks(const World& world);
uint32_t warps_per_block(const World& world);  // 1 in a launch without blocks

// Returns the launch coordinates of a lane of a warp, as World::layout gives them. In a launch with blocks, x
// runs fastest within the block. A lane without a thread is outside of the launch.
std::array<uint32_t, 3> launch_id(const World& world, uint32_t warp_index, int lane);
// Returns the same as the shader reads it, which differs where the launch is a window of a larger one.
std::array<uint32_t, 3> shader_launch_id(const World& world, uint32_t warp_index, int lane);
// Return the same for the thread that is in a lane of a warp now. A core may have moved it there.
std::array<uint32_t, 3> thread_id(const World& world, const WarpContext& warp, int lane);
std::array<uint32_t, 3> shader_thread_id(const WarpContext& warp, int lane);

// Empties `block` for block `index` of the launch: shared memory is zeroed, and no warp has arrived anywhere.
// Blocks are numbered x fastest, unless the layout says otherwise.
void start_block(const World& world, Block& block, uint32_t index);
// Puts a warp of the block into `warp`, at the entry of the ray generation or compute shader. Neither object
// may move until the warp has ended.
void start_warp(const World& world, WarpContext& warp, Block& block, uint32_t warp_in_block,
                const Seat& seat);

// Returns whether any shader of the image reads the clock or the time.
bool reads_clock(const Image& image);
// Writes clock and time for the warp's next instruction. `clock_mhz` turns cycles into time; with 0 the time
// is 0.
void fill_clock(const Image& image, WarpContext& warp, Cycle now, double clock_mhz);

}  // namespace glint::exec
