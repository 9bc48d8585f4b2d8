// Builds a small acceleration structure and aims rays at chosen points of its primitives.
// SPDX-License-Identifier: Apache-2.0
#include "tests/ops/ray_scene.h"

#include <charconv>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "rtunit/structure/build.h"
#include "rtunit/structure/structure.h"

namespace glint::test {
namespace {

struct Placed {
  std::array<double, 12> matrix;
  uint32_t custom, mask, sbt_offset, flags;
};
constexpr Placed kPlaced[RayScene::kInstances] = {
    {{0.75, -0.5, 0, 1, 0.5, 0.75, 0, 2, 0, 0.25, 1.5, -3}, 1000, 0x0f, 5, 0},
    {{1, 0.25, 0, 0, 0, 2, 0, 100, 0, 0, 1, 7}, 0xabcdef, 0x3c, 9, 0},
    {{-1, 0, 0.125, 3, 0, 1.25, 0, -100, 0.25, 0, -0.5, 20}, 77, 0xf0, 0, rt::instance_flag::kFlipFacing}};

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

size_t number_of(std::string_view text) {
  if (text == "x" || text == "y" || text == "z") return size_t(text[0] - 'x');
  size_t out = 0;
  std::from_chars(text.data(), text.data() + text.size(), out);
  return out;
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

std::optional<Value> value_of_ray(std::span<const std::string_view> words, const Aim& aim) {
  if (words[0] == "tmin") return real(aim.tmin);
  if (words[0] == "origin") return real(aim.origin[number_of(words[1])]);
  if (words[0] == "direction") return real(aim.direction[number_of(words[1])]);
  return std::nullopt;
}

std::optional<Value> value_of_instance(std::span<const std::string_view> words, const Aim& aim) {
  const auto inverse = inverse_of(aim.to_world);
  if (words[0] == "instance") return integer(aim.instance);
  if (words[0] == "custom") return integer(aim.custom);
  if (words[0] == "sbt_offset") return integer(aim.sbt_offset);
  if (words[0] == "geometry") return integer(aim.geometry);
  if (words[0] == "primitive") return integer(aim.primitive);
  if (words[0] == "object_to_world") return real(aim.to_world[number_of(words[1])]);
  if (words[0] == "world_to_object") return real(inverse[number_of(words[1])]);
  if (words[0] != "object") return std::nullopt;
  const bool is_origin = words[1] == "origin";
  return real(transformed(inverse, is_origin ? aim.origin : aim.direction, is_origin)[number_of(words[2])]);
}

Value value_of_corner(std::string_view number, const Aim& aim) {
  return real(aim.corner[number_of(number) / 3][number_of(number) % 3]);
}

bool Value::is(uint32_t word) const {
  if (!is_float) return double(word) == number;
  return std::fabs(value_of(kSingle, word) - number) <= 1e-4 * (1 + std::fabs(number));
}

uint32_t RayScene::sbt_offset_of(uint32_t instance) const {
  return instance + 1 == kInstances ? last_sbt_offset_ : kPlaced[instance].sbt_offset;
}

RayScene::RayScene(mem::AddressSpace& memory, uint32_t last_sbt_offset) : last_sbt_offset_(last_sbt_offset) {
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
    rt::Instance instance{{},          kPlaced[i].custom, kPlaced[i].mask, sbt_offset_of(i), kPlaced[i].flags,
                          has_boxes(i)};
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
  out.custom = placed.custom, out.mask = placed.mask, out.to_world = placed.matrix;
  out.sbt_offset = sbt_offset_of(out.instance);
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
