// Reads what several ray instructions have in common: a ray's operands, object space, numbered objects.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "isa/inst.h"
#include "isa/warp.h"
#include "memsys/address_space.h"
#include "rtunit/structure/structure.h"
#include "rtunit/traversal/ray.h"

namespace glint::exec {

inline float as_float(uint32_t bits) {
  return std::bit_cast<float>(bits);
}
inline uint32_t as_bits(float x) {
  return std::bit_cast<uint32_t>(x);
}

// Return a lane's value of an operand of 32 bits, and of one of 64 bits.
inline uint32_t read_word(const isa::Warp& regs, const isa::Inst& inst, size_t operand, int lane) {
  return regs.read(inst.operand[operand])[lane];
}
inline Address read_address(const isa::Warp& regs, const isa::Inst& inst, size_t operand, int lane) {
  return read_word(regs, inst, operand, lane) | Address(regs.read(isa::Slot(inst.operand[operand] + 1))[lane])
                                                    << 32;
}

// This is the number of operands of a ray: origin, tmin, direction, tmax.
inline constexpr size_t kRayOperands = 8;
inline void read_ray(const isa::Warp& regs, const isa::Inst& inst, size_t first, int lane, rt::Ray& ray) {
  const auto value = [&](size_t i) { return as_float(read_word(regs, inst, first + i, lane)); };
  for (size_t axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = value(axis);
    ray.direction[axis] = value(4 + axis);
  }
  ray.t_min = value(3);
  ray.t_max = value(7);
}

// Returns coordinate `axis` of a point or direction of the world in the space of an instance.
inline float object_point(const rt::InstanceLeaf& leaf, const std::array<float, 3>& x, size_t axis) {
  const float* m = leaf.world_to_object.data() + 4 * axis;
  return m[0] * x[0] + m[1] * x[1] + m[2] * x[2] + m[3];
}
inline float object_direction(const rt::InstanceLeaf& leaf, const std::array<float, 3>& x, size_t axis) {
  const float* m = leaf.world_to_object.data() + 4 * axis;
  return m[0] * x[0] + m[1] * x[1] + m[2] * x[2];
}

// Returns coordinate `number` of the corners of the triangle that was hit: x, y, z of the first, of the
// second, of the third. Choice: it is 0 when there is no triangle; Vulkan leaves it undefined.
inline float corner_of(const rt::Hit& hit, uint32_t number, const mem::AddressSpace& memory) {
  const std::byte* const bytes =
      hit.triangle_leaf ? memory.find(hit.triangle_leaf, sizeof(rt::TriangleLeaf)) : nullptr;
  if (!bytes || number >= 9) return 0;
  rt::TriangleLeaf leaf;
  std::memcpy(&leaf, bytes, sizeof leaf);
  const bool second = leaf.count > 1 && leaf.primitive_of(1) == hit.primitive;
  const uint32_t corner = number / 3;
  return leaf.vertex[second ? leaf.second >> 2 * corner & 3 : corner][number % 3];
}

}  // namespace glint::exec
