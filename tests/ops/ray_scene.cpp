// Builds a small acceleration structure and aims rays at chosen points of its primitives.
// SPDX-License-Identifier: Apache-2.0
#include "tests/ops/ray_scene.h"

#include <span>
#include <utility>
#include <vector>

#include "rtunit/structure/build.h"
#include "rtunit/structure/structure.h"

namespace glint::test {
namespace {

struct Placed {
  std::array<double, 12> matrix;
  uint32_t custom, sbt_offset, flags;
};
constexpr Placed kPlaced[RayScene::kInstances] = {
    {{0.75, -0.5, 0, 1, 0.5, 0.75, 0, 2, 0, 0.25, 1.5, -3}, 1000, 5, 0},
    {{1, 0.25, 0, 0, 0, 2, 0, 100, 0, 0, 1, 7}, 0xabcdef, 9, 0},
    {{-1, 0, 0.125, 3, 0, 1.25, 0, -100, 0.25, 0, -0.5, 20}, 77, 0x123456, rt::instance_flag::kFlipFacing}};

// Primitives stand four units apart, so that a steep ray meets one of them only.
double middle_of(uint32_t geometry, uint32_t primitive) {
  return 4.0 * (geometry * RayScene::kPrimitives + primitive);
}

Point minus(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double as_single(double x) {
  return double(float(x));
}

rt::StructureInfo build_boxes(mem::AddressSpace& memory) {
  std::vector<rt::Bounds> bounds[RayScene::kGeometries];
  rt::BottomLevel level;
  for (uint32_t g = 0; g < RayScene::kGeometries; ++g) {
    for (uint32_t p = 0; p < RayScene::kPrimitives; ++p) {
      const auto x = float(middle_of(g, p));
      rt::Bounds box;
      box.low = {x - 1, -1, -0.5f};
      box.high = {x + 1, 1, 0.5f};
      bounds[g].push_back(box);
    }
    rt::Geometry geometry;
    geometry.aabbs = bounds[g];
    geometry.opaque = g == 0;
    level.geometries.push_back(geometry);
  }
  return rt::build_bottom(memory, "boxes", level, {});
}

}  // namespace

Point transformed(const std::array<double, 12>& matrix, const Point& point, double w) {
  Point out{};
  for (size_t row = 0; row < 3; ++row) {
    out[row] = matrix[4 * row + 3] * w;
    for (size_t i = 0; i < 3; ++i) out[row] += matrix[4 * row + i] * point[i];
  }
  return out;
}

std::array<double, 12> inverse_of(const std::array<double, 12>& matrix) {
  const Point x{matrix[0], matrix[1], matrix[2]}, y{matrix[4], matrix[5], matrix[6]},
      z{matrix[8], matrix[9], matrix[10]}, moved{matrix[3], matrix[7], matrix[11]};
  const double determinant = dot(x, cross(y, z));
  const Point columns[3] = {cross(y, z), cross(z, x), cross(x, y)};
  std::array<double, 12> out{};
  for (size_t row = 0; row < 3; ++row)
    for (size_t i = 0; i < 3; ++i) {
      out[4 * row + i] = columns[i][row] / determinant;
      out[4 * row + 3] -= out[4 * row + i] * moved[i];
    }
  return out;
}

RayScene::RayScene(mem::AddressSpace& memory) {
  std::vector<std::array<float, 3>> positions;
  std::vector<uint32_t> indices[kGeometries];
  for (uint32_t g = 0; g < kGeometries; ++g)
    for (uint32_t p = 0; p < kPrimitives; ++p) {
      const double x = middle_of(g, p), tilt = 0.125 * double(p);
      std::array<Point, 3> corner{{{x - 1, -1, tilt}, {x + 1, -0.75, -tilt}, {x + 0.25, 1, 0.25}}};
      if (p == 1) std::swap(corner[1], corner[2]);  // the other side
      triangles_[g][p] = corner;
      for (const Point& at : corner) {
        indices[g].push_back(uint32_t(positions.size()));
        positions.push_back({float(at[0]), float(at[1]), float(at[2])});
      }
    }
  rt::BottomLevel level;
  for (const std::vector<uint32_t>& list : indices) {
    rt::Geometry geometry;
    geometry.positions = std::as_bytes(std::span(positions));
    geometry.indices = list;
    geometry.opaque = false;
    level.geometries.push_back(geometry);
  }
  const std::vector<rt::StructureInfo> bottoms{rt::build_bottom(memory, "triangles", level, {}),
                                               build_boxes(memory)};
  std::vector<rt::Instance> instances;
  for (uint32_t i = 0; i < kInstances; ++i) {
    rt::Instance instance{{}, kPlaced[i].custom, 0xff, kPlaced[i].sbt_offset, kPlaced[i].flags, has_boxes(i)};
    for (size_t n = 0; n < 12; ++n) instance.transform[n] = float(kPlaced[i].matrix[n]);
    instances.push_back(instance);
  }
  address_ = rt::build_top(memory, "top", instances, bottoms, {}).address;
}

Aim RayScene::aim(Random& random, bool must_hit) const {
  const auto fraction = [&](double low, double high) {
    return low + (high - low) * random.below(1025) / 1024;
  };
  Aim out;
  out.instance = random.below(kInstances), out.geometry = random.below(kGeometries),
  out.primitive = random.below(kPrimitives);
  const Placed& placed = kPlaced[out.instance];
  out.custom = placed.custom, out.sbt_offset = placed.sbt_offset, out.to_world = placed.matrix;
  out.is_box = has_boxes(out.instance);
  out.is_opaque = out.is_box && out.geometry == 0;
  out.corner = triangles_[out.geometry][out.primitive];
  out.t = 1 + 0.5 * random.below(8);
  out.tmax = out.t + 4;
  out.u = fraction(0.1, 0.5), out.v = fraction(0.1, 0.4);
  Point target{middle_of(out.geometry, out.primitive) + fraction(-0.5, 0.5), fraction(-0.5, 0.5), 0.5};
  for (size_t i = 0; i < 3 && !out.is_box; ++i)
    target[i] = out.corner[0][i] * (1 - out.u - out.v) + out.corner[1][i] * out.u + out.corner[2][i] * out.v;
  const double side = random.below(2) ? 1 : -1;
  const Point along{fraction(-0.1, 0.1), fraction(-0.1, 0.1), out.is_box ? -1 : side};
  out.hits = must_hit || random.below(8) != 0;
  // The ray starts t times its direction before the target, or flies away from there.
  Point origin{};
  for (size_t i = 0; i < 3; ++i) origin[i] = target[i] - along[i] * out.t;
  out.origin = transformed(placed.matrix, origin, 1);
  out.direction = transformed(placed.matrix, along, 0);
  for (size_t i = 0; i < 3; ++i) {
    out.origin[i] = as_single(out.origin[i]);
    out.direction[i] = as_single(out.hits ? out.direction[i] : -out.direction[i]);
  }
  // Counterclockwise triangles face the ray, as seen from the ray in object space.
  const Point normal = cross(minus(out.corner[1], out.corner[0]), minus(out.corner[2], out.corner[0]));
  out.is_front = (dot(normal, along) < 0) != (placed.flags == rt::instance_flag::kFlipFacing);
  return out;
}

}  // namespace glint::test
