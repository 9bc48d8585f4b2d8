// Tests the contract of warp layouts: every thread is in exactly one lane of one warp, every block starts
// once.
// SPDX-License-Identifier: Apache-2.0
#include <set>
#include <tuple>
#include <utility>

#include "core/params.h"
#include "exec/executor.h"
#include "tests/support/catch.h"
#include "tests/unit/core/one_core.h"

namespace glint::core {
namespace {

using exec::Block, exec::Executor, exec::Image, exec::launch_id, exec::link, exec::set_blocks,
    exec::WarpContext, exec::World;

std::shared_ptr<const exec::WarpLayout> make(const std::string& name) {
  return Registry<exec::WarpLayout>::instance().entry(name).make_default({});
}

// Holds a launch of a program that does nothing.
struct Launch {
  Launch(const std::string& layout, std::array<uint32_t, 3> size) {
    Code code;
    code.add("exit");
    std::vector<isa::Program> programs{code.program()};
    image = link(programs);
    world.image = &image;
    world.raygen = 0;
    world.launch_size = size;
    world.layout = make(layout);
  }
  World world;
  Image image;
};

}  // namespace

TEST_CASE("a layout's tile has a place for each lane, and its order a turn for each place of a grid") {
  for (const std::string& name : Registry<exec::WarpLayout>::names()) {
    CAPTURE(name);
    const auto layout = make(name);
    const exec::WarpLayout::Place tile = layout->tile();
    if (tile.x) {
      CHECK(tile.x * tile.y == uint32_t(kLanes));
      std::set<std::pair<uint32_t, uint32_t>> places;
      for (int lane = 0; lane < kLanes; ++lane) {
        const auto place = layout->lane_place(lane);
        CHECK((place.x < tile.x && place.y < tile.y));
        places.insert({place.x, place.y});
      }
      CHECK(places.size() == size_t(kLanes));
    }
    for (const auto& [columns, rows] :
         {std::pair{1u, 1u}, {7u, 1u}, {1u, 9u}, {4u, 4u}, {13u, 6u}, {3u, 40u}}) {
      std::set<std::pair<uint32_t, uint32_t>> places;
      for (uint32_t n = 0; n < columns * rows; ++n) {
        const auto place = layout->nth(n, columns, rows);
        REQUIRE((place.x < columns && place.y < rows));
        places.insert({place.x, place.y});
      }
      CHECK(places.size() == columns * rows);
    }
  }
}

TEST_CASE("every thread of a launch without blocks is one active lane of one warp, under every layout") {
  for (const std::string& name : Registry<exec::WarpLayout>::names())
    for (const std::array<uint32_t, 3> size : {std::array{64u, 32u, 1u},
                                               {61u, 35u, 1u},
                                               {100u, 1u, 1u},
                                               {9u, 5u, 3u},
                                               {1u, 7u, 2u},
                                               {5u, 3u, 1u}}) {
      CAPTURE(name, size[0], size[1], size[2]);
      const Launch launch(name, size);
      const Executor executor(launch.world);
      std::set<std::tuple<uint32_t, uint32_t, uint32_t>> seen;
      for (uint32_t w = 0; w < executor.num_warps(); ++w) {
        WarpContext warp;
        executor.start(warp, w);
        REQUIRE(warp.simt.active != 0);
        for_each_lane(warp.simt.active, [&](int lane) {
          const auto id = launch_id(launch.world, w, lane);
          REQUIRE((id[0] < size[0] && id[1] < size[1] && id[2] < size[2]));
          REQUIRE(seen.insert({id[0], id[1], id[2]}).second);
          for (size_t axis = 0; axis < 3; ++axis)
            REQUIRE(warp.regs.bank[2][(size_t(isa::Special::LaunchX) + axis) * kLanes + size_t(lane)] ==
                    id[axis]);
        });
      }
      CHECK(seen.size() == size_t{size[0]} * size[1] * size[2]);
    }
}

TEST_CASE("every block of a grid starts once, under every layout") {
  for (const std::string& name : Registry<exec::WarpLayout>::names()) {
    CAPTURE(name);
    Launch launch(name, {1, 1, 1});
    set_blocks(launch.world, {6, 5, 2}, {8, 4, 2}, 0);
    const Executor executor(launch.world);
    REQUIRE(executor.num_blocks() == 60);
    std::set<std::array<uint32_t, 3>> seen;
    for (uint32_t b = 0; b < executor.num_blocks(); ++b) {
      Block block;
      executor.start(block, b);
      seen.insert(block.id());
      // Threads of a block are numbered x fastest, whatever the layout.
      const auto first = launch_id(launch.world, b * executor.warps_per_block(), 9);
      CHECK(first ==
            std::array<uint32_t, 3>{block.id()[0] * 8 + 1, block.id()[1] * 4 + 1, block.id()[2] * 2});
    }
    CHECK(seen.size() == 60);
  }
}

TEST_CASE("8x4 tiles go row by row, Morton tiles in Z-order") {
  const Launch tiles("tile_8x4", {32, 16, 1}), morton("morton", {32, 16, 1});
  using Id = std::array<uint32_t, 3>;

  CHECK(launch_id(tiles.world, 0, 31) == Id{7, 3, 0});
  CHECK(launch_id(tiles.world, 1, 0) == Id{8, 0, 0});
  CHECK(launch_id(tiles.world, 4, 8) == Id{0, 5, 0});
  CHECK(launch_id(morton.world, 0, 1) == Id{1, 0, 0});
  CHECK(launch_id(morton.world, 0, 2) == Id{0, 1, 0});
  CHECK(launch_id(morton.world, 0, 16) == Id{4, 0, 0});
  CHECK(launch_id(morton.world, 2, 0) == Id{0, 4, 0});
  CHECK(launch_id(morton.world, 4, 0) == Id{16, 0, 0});
}

TEST_CASE("a launch of fewer rows than a tile has is laid out in full warps") {
  const Launch launch("tile_8x4", {96, 1, 1});
  CHECK(Executor(launch.world).num_warps() == 3);
}

}  // namespace glint::core
