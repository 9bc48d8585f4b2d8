// Starts blocks and warps of a launch: says who they are, and what they read about themselves.
// SPDX-License-Identifier: Apache-2.0
#include "exec/launch.h"

#include <algorithm>
#include <utility>

#include "exec/ray_specials.h"

namespace glint::exec {

using isa::Special;

namespace {

uint64_t product(const std::array<uint32_t, 3>& size) {
  return uint64_t(size[0]) * size[1] * size[2];
}

std::array<uint32_t, 3> coordinates(uint64_t index, const std::array<uint32_t, 3>& size) {
  return {uint32_t(index % size[0]), uint32_t(index / size[0] % size[1]),
          uint32_t(index / size[0] / size[1])};
}

bool has_blocks(const World& world) {
  return world.block_size[0] != 0;
}

std::array<uint32_t, 3> grid_size(const World& world) {
  std::array<uint32_t, 3> grid;
  for (size_t axis = 0; axis < 3; ++axis) grid[axis] = world.launch_size[axis] / world.block_size[axis];
  return grid;
}

// Holds the tiles of a launch without blocks, or zeros when its warps are consecutive launch indices.
struct Tiles {
  uint32_t width = 0, height = 0, columns = 0, rows = 0;
};
Tiles tiles_of(const World& world) {
  if (!world.layout || has_blocks(world)) return {};
  const auto [width, height] = world.layout->tile();
  const auto& size = world.launch_size;
  if (width == 0 || size[1] < height) return {};
  return {width, height, (size[0] + width - 1) / width, (size[1] + height - 1) / height};
}

// Returns the id of block `index` of the launch, in the layout's order.
std::array<uint32_t, 3> block_id(const World& world, uint32_t index) {
  const std::array<uint32_t, 3> grid = grid_size(world);
  if (!world.layout) return coordinates(index, grid);
  const auto [x, y] = world.layout->nth(index % (grid[0] * grid[1]), grid[0], grid[1]);
  return {x, y, index / (grid[0] * grid[1])};
}

// Returns the lanes that have a thread, which are all lanes except at the edges of the launch or of the
// block.
LaneMask lanes_of(const World& world, uint32_t warp_index, uint32_t warp_in_block) {
  if (tiles_of(world).width == 0) {
    const uint64_t all = product(has_blocks(world) ? world.block_size : world.launch_size);
    const uint64_t left = all - uint64_t(has_blocks(world) ? warp_in_block : warp_index) * kLanes;
    return left >= uint64_t(kLanes) ? kAllLanes : (LaneMask{1} << left) - 1;
  }
  LaneMask lanes = 0;
  for (int lane = 0; lane < kLanes; ++lane) {
    const std::array<uint32_t, 3> id = launch_id(world, warp_index, lane);
    if (id[0] < world.launch_size[0] && id[1] < world.launch_size[1]) lanes |= LaneMask{1} << lane;
  }
  return lanes;
}

// Writes what the warp's program can read about its place in the launch and in the machine.
void fill_launch_specials(const World& world, WarpContext& warp, const Seat& seat) {
  const bool blocks = has_blocks(world);
  const std::array<uint32_t, 3> size =
      blocks ? world.block_size : std::array<uint32_t, 3>{uint32_t(kLanes), 1, 1};
  const std::array<uint32_t, 3> grid =
      blocks ? grid_size(world) : std::array<uint32_t, 3>{num_blocks(world), 1, 1};
  std::array<uint32_t, 3> block_number = warp.block->id();
  for (size_t axis = 0; blocks && axis < 3; ++axis) block_number[axis] += world.first_id[axis] / size[axis];
  const std::array<uint32_t, 3>& whole = world.whole_size[0] ? world.whole_size : world.launch_size;
  const auto& row = world.image->special_row;
  const auto set = [&](Special s, size_t lane, uint32_t value) {
    if (row[size_t(s)] != Image::kNoRow) warp.regs.bank[2][row[size_t(s)] * kLanes + lane] = value;
  };
  const auto axis_of = [](Special x, size_t axis) { return Special(size_t(x) + axis); };
  for (size_t lane = 0; lane < size_t(kLanes); ++lane) {
    const auto id = shader_launch_id(world, warp.warp_index, int(lane));
    const auto thread = coordinates((blocks ? uint64_t(warp.warp_in_block) * kLanes : 0) + lane, size);
    for (size_t axis = 0; axis < 3; ++axis) {
      set(axis_of(Special::LaunchX, axis), lane, id[axis]);
      set(axis_of(Special::LaunchSizeX, axis), lane, whole[axis]);
      set(axis_of(Special::TidX, axis), lane, thread[axis]);
      set(axis_of(Special::NtidX, axis), lane, size[axis]);
      set(axis_of(Special::CtaidX, axis), lane, block_number[axis]);
      set(axis_of(Special::NctaidX, axis), lane, grid[axis]);
    }
    const LaneMask bit = LaneMask{1} << lane;
    const std::pair<Special, uint32_t> values[] = {
        {Special::LaneId, uint32_t(lane)},
        {Special::WarpId, seat.slots > 1 ? seat.slot : warp.warp_in_block},
        {Special::NwarpId, std::max(seat.slots, warps_per_block(world))},
        {Special::SmId, seat.core},
        {Special::NsmId, seat.cores},
        {Special::LanemaskEq, bit},
        {Special::LanemaskLe, bit | (bit - 1)},
        {Special::LanemaskLt, bit - 1},
        {Special::LanemaskGe, ~(bit - 1)},
        {Special::LanemaskGt, ~(bit | (bit - 1))},
        {Special::TotalSmemSize, world.shared_bytes},
        {Special::DynamicSmemSize, world.dynamic_shared_bytes}};
    for (const auto& [special, value] : values) set(special, lane, value);
  }
}

}  // namespace

uint32_t warps_per_block(const World& world) {
  return has_blocks(world) ? uint32_t((product(world.block_size) + kLanes - 1) / kLanes) : 1;
}

std::array<uint32_t, 3> launch_id(const World& world, uint32_t warp_index, int lane) {
  if (const Tiles tiles = tiles_of(world); tiles.width) {
    const uint32_t layer = tiles.columns * tiles.rows;
    const auto [column, row] = world.layout->nth(warp_index % layer, tiles.columns, tiles.rows);
    const auto [x, y] = world.layout->lane_place(lane);
    return {column * tiles.width + x, row * tiles.height + y, warp_index / layer};
  }
  const uint32_t warps = warps_per_block(world);
  const uint64_t thread =
      uint64_t(has_blocks(world) ? warp_index % warps : warp_index) * kLanes + uint64_t(lane);
  if (!has_blocks(world)) return coordinates(thread, world.launch_size);
  const std::array<uint32_t, 3> block = block_id(world, warp_index / warps);
  std::array<uint32_t, 3> id = coordinates(thread, world.block_size);
  for (size_t axis = 0; axis < 3; ++axis) id[axis] += block[axis] * world.block_size[axis];
  return id;
}

std::array<uint32_t, 3> shader_launch_id(const World& world, uint32_t warp_index, int lane) {
  std::array<uint32_t, 3> id = launch_id(world, warp_index, lane);
  for (size_t axis = 0; axis < 3; ++axis) id[axis] += world.first_id[axis];
  return id;
}

std::array<uint32_t, 3> thread_id(const World& world, const WarpContext& warp, int lane) {
  std::array<uint32_t, 3> id = shader_thread_id(warp, lane);
  for (size_t axis = 0; axis < 3; ++axis) id[axis] -= world.first_id[axis];
  return id;
}

std::array<uint32_t, 3> shader_thread_id(const WarpContext& warp, int lane) {
  std::array<uint32_t, 3> id;
  for (size_t axis = 0; axis < 3; ++axis)  // These rows are at the start (Image::special_row).
    id[axis] = warp.regs.bank[2][(size_t(Special::LaunchX) + axis) * kLanes + size_t(lane)];
  return id;
}

uint32_t num_blocks(const World& world) {
  if (has_blocks(world)) return uint32_t(product(grid_size(world)));
  if (const Tiles tiles = tiles_of(world); tiles.width)
    return tiles.columns * tiles.rows * world.launch_size[2];
  return uint32_t((product(world.launch_size) + kLanes - 1) / kLanes);
}

void start_block(const World& world, Block& block, uint32_t index) {
  const auto id = has_blocks(world) ? block_id(world, index) : std::array<uint32_t, 3>{index, 0, 0};
  block.start(index, id, warps_per_block(world), world.shared_bytes);
}

void start_warp(const World& world, WarpContext& warp, Block& block, uint32_t warp_in_block,
                const Seat& seat) {
  const Image& image = *world.image;
  const size_t registers = size_t(image.num_registers) * kLanes;
  if (!warp.regs.bank[0]) {
    warp.own_registers = allocate_rows(image.num_registers);
    warp.regs.bank[0] = warp.own_registers.get();
  }
  std::fill_n(warp.regs.bank[0], registers, 0u);
  if (!warp.own_specials) warp.own_specials = allocate_rows(image.num_special_rows);
  warp.regs.bank[1] = image.constants.get();
  warp.regs.bank[2] = warp.own_specials.get();
  std::fill_n(warp.regs.bank[2], size_t{image.num_special_rows} * kLanes, 0u);
  warp.regs.predicate.fill(0);
  warp.local.assign(size_t((world.local_bytes + 3) / 4) * kLanes, 0u);
  warp.warp_index = block.index() * warps_per_block(world) + warp_in_block;
  warp.block = &block;
  warp.warp_in_block = warp_in_block;
  warp.slot = seat.slot;
  block.warps[warp_in_block] = &warp;
  warp.depth = warp.callables = 0;
  warp.next_time.fill(0);
  warp.instructions = warp.effects = 0;
  warp.waiting_loop = {};
  warp.waiting_for_rays = warp.waiting_at_barrier = warp.waits_for_phase = false;

  warp.simt.start(image.shaders[world.raygen].entry, lanes_of(world, warp.warp_index, warp_in_block));
  fill_launch_specials(world, warp, seat);
  fill_specials(world, warp, warp.simt.active, image.shaders[world.raygen]);
}

bool reads_clock(const Image& image) {
  return std::any_of(image.shaders.begin(), image.shaders.end(), [](const Shader& shader) {
    return shader.specials_used[size_t(Special::Clock)] || shader.specials_used[size_t(Special::ClockHi)] ||
           shader.specials_used[size_t(Special::GlobalTimerLo)] ||
           shader.specials_used[size_t(Special::GlobalTimerHi)];
  });
}

void fill_clock(const Image& image, WarpContext& warp, Cycle now, double clock_mhz) {
  const auto set = [&](Special s, uint64_t value) {
    const uint8_t row = image.special_row[size_t(s)];
    if (row != Image::kNoRow) std::fill_n(warp.regs.bank[2] + row * kLanes, kLanes, uint32_t(value));
  };
  const uint64_t nanoseconds = clock_mhz > 0.0 ? uint64_t(double(now) * 1000.0 / clock_mhz) : 0;
  set(Special::Clock, now);
  set(Special::ClockHi, now >> 32);
  set(Special::GlobalTimerLo, nanoseconds);
  set(Special::GlobalTimerHi, nanoseconds >> 32);
}

}  // namespace glint::exec
