// Declares the interface of the policies that choose which threads of a launch form a warp, and in which
// order warps or blocks start.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>

#include "base/registry.h"
#include "base/types.h"

namespace glint::exec {

// Contract (tests/contract/warp_layout_test.cpp):
//  - tile() has kLanes places, or is {0, 0}: warps are then kLanes consecutive launch indices, whatever the
//    launch's width.
//  - lane_place() gives each lane another place of the tile.
//  - nth() gives each n below columns * rows another place of that grid.
//  - All three are functions of their arguments only: results of a launch never depend on when they are
//    called.
//
// Tiles apply to launches without blocks. Model: the warps of a block are its consecutive threads under every
// layout, as PTX has it and drivers do for Vulkan; for a launch with blocks the layout only orders the
// blocks. Choice: a launch with fewer rows than a tile is laid out by consecutive launch indices, so that its
// warps are full.
class WarpLayout {
 public:
  static constexpr PolicyKind kKind{"core.warp_layout", "exec/warp_layouts"};
  struct Context {};
  struct Place {
    uint32_t x = 0, y = 0;
    bool operator==(const Place&) const = default;
  };
  virtual ~WarpLayout() = default;
  virtual Place tile() const = 0;  // width and height
  virtual Place lane_place(int lane) const = 0;
  virtual Place nth(uint32_t n, uint32_t columns, uint32_t rows) const = 0;
};

}  // namespace glint::exec
