// Describes opacity micromaps: which parts of a triangle are opaque or transparent, and which a shader
// decides.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "rtunit/structure/structure.h"

namespace glint::rt {

// Says what a ray meets in a micro-triangle. The values are those of VK_OPACITY_MICROMAP_FORMAT_4_STATE_EXT;
// VK_OPACITY_MICROMAP_FORMAT_2_STATE_EXT has the first two. The last two are for a shader to decide, and say
// how a ray decides that asks for 2 states.
enum class MicroState : uint8_t { Transparent, Opaque, UnknownTransparent, UnknownOpaque };

// Says how a triangle is cut: `level` times, each triangle into four. All micromaps of a structure are alike.
struct MicromapFormat {
  static constexpr uint32_t kMostLevels = 6;
  bool two_states = false;
  uint32_t level = 4;

  uint32_t bits() const { return two_states ? 1 : 2; }  // of a state
  uint32_t num_states() const { return 1u << 2 * level; }
  uint32_t bytes() const { return std::max(num_states() * bits() / 8, 1u); }  // of a map; a power of two
  bool operator==(const MicromapFormat&) const = default;
};

// Holds the micromaps of a geometry's triangles.
struct Micromaps {
  MicromapFormat format;
  // By primitive: the number of its map. Below zero the whole triangle has the state -1 - index, as Vulkan's
  // special indices say.
  std::vector<int32_t> index;
  std::vector<uint8_t> states;  // of one map after the other, from the low bits of a byte to the high ones
  // True: the maps decide before anything else, in place of the geometry's opacity, as in Vulkan. False: they
  // stand for an any-hit shader, and are asked where it would be.
  bool come_first = false;

  static constexpr int32_t uniform(MicroState state) { return -1 - int32_t(state); }
};

// Returns the state of micro-triangle `number` of the map that begins at `map`.
inline MicroState micro_state(const MicromapFormat& format, const uint8_t* map, uint32_t number) {
  const uint32_t bit = number * format.bits();
  return MicroState(map[bit / 8] >> bit % 8 & (format.two_states ? 1 : 3));
}

// Names a micro-triangle by the row and column of the grid that the cuts make. `u` counts from the edge of
// the corners 0 and 2 towards corner 1, and `v` from that of 0 and 1 towards corner 2. A flipped one stands
// upside down.
struct MicroTriangle {
  uint32_t u = 0, v = 0;
  bool is_flipped = false;
};

// Returns the micro-triangle at the weights u and v of corners 1 and 2.
inline MicroTriangle micro_triangle_at(float u, float v, uint32_t level) {
  const uint32_t size = 1u << level;
  const float across = std::clamp(u, 0.0f, 1.0f) * float(size), up = std::clamp(v, 0.0f, 1.0f) * float(size);
  MicroTriangle out{std::min(uint32_t(across), size - 1), std::min(uint32_t(up), size - 1), false};
  // Rounding may have put the point behind the long edge.
  if (out.u + out.v >= size) out.u = size - 1 - out.v;
  out.is_flipped = (across - float(out.u)) + (up - float(out.v)) >= 1 && out.u + out.v < size - 1;
  return out;
}

// Returns the place of a micro-triangle in its map. A triangle's four parts follow each other like this: the
// one at corner 0, the middle, the one at corner 1, the one at corner 2. The middle stands upside down; in it
// and in the last part the corners 0 and 1 change places (Vulkan 1.3, "Ray Opacity Micromap").
inline uint32_t number_of(const MicroTriangle& triangle, uint32_t level) {
  uint32_t size = 1u << level;
  // These count from the edges opposite of the corners 0, 1 and 2.
  std::array<uint32_t, 3> from{size - 1 - triangle.u - triangle.v - triangle.is_flipped, triangle.u,
                               triangle.v};
  uint32_t number = 0;
  while (size > 1) {
    size /= 2;
    const uint32_t part = from[0] >= size ? 0 : from[1] >= size ? 2 : from[2] >= size ? 3 : 1;
    number = 4 * number + part;
    if (part == 1)
      for (uint32_t& distance : from) distance = size - 1 - distance;
    else
      from[part == 0 ? 0 : part - 1] -= size;
    if (part == 1 || part == 3) std::swap(from[0], from[1]);
  }
  return number;
}

// Describes the micromaps of a structure. It lies where StructureHeader::micromaps says, and the maps follow
// it.
struct MicromapTable {
  uint32_t two_states = 0, level = 0;
  uint32_t num_maps = 0;
  uint32_t pad = 0;
  MicromapFormat format() const { return {two_states != 0, level}; }
  uint64_t bytes() const { return sizeof *this + uint64_t{num_maps} * format().bytes(); }
};
static_assert(sizeof(MicromapTable) == kBlockBytes);

}  // namespace glint::rt
