// Makes scenes of everything that a structure can hold, and finds a ray's hits by testing all primitives.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "rtunit/intersection/box_test.h"
#include "rtunit/intersection/triangle_test.h"
#include "rtunit/node_format.h"
#include "rtunit/structure/micromaps.h"
#include "tests/support/rt_launch.h"

namespace glint::rt::test {

// Holds the geometries of a bottom level. The vectors keep what the geometries point to.
struct BottomScene {
  BottomScene() = default;
  BottomScene(BottomScene&&) = default;
  BottomScene(const BottomScene&) = delete;  // the geometries would point into the other
  std::deque<Positions> positions;
  std::deque<std::vector<Bounds>> boxes;
  std::deque<Micromaps> micromaps;
  BottomLevel level;
  void add_triangles(Positions p, bool opaque) {
    positions.push_back(std::move(p));
    level.geometries.push_back(triangles(positions.back(), opaque));
  }
  // Gives the geometry that was added last its maps.
  void add_micromaps(Micromaps maps) {
    micromaps.push_back(std::move(maps));
    level.geometries.back().micromaps = &micromaps.back();
  }
  void add_boxes(std::vector<Bounds> b, bool opaque) {
    boxes.push_back(std::move(b));
    Geometry g;
    g.aabbs = boxes.back();
    g.opaque = opaque;
    level.geometries.push_back(g);
  }
};
struct Scene {
  Scene() = default;
  Scene(Scene&&) = default;
  Scene(const Scene&) = delete;
  std::deque<BottomScene> bottoms;
  std::vector<Instance> instances;
};

// Holds a scene in memory, as some options build it.
struct BuiltScene {
  mem::AddressSpace memory;
  std::vector<StructureInfo> bottoms;
  StructureInfo top;
  BuiltScene(const Scene& scene, const std::string& format)
      : BuiltScene(scene, BuildOptions{format.c_str()}) {}
  BuiltScene(const Scene& scene, const BuildOptions& options) {
    for (const BottomScene& b : scene.bottoms)
      bottoms.push_back(build_bottom(memory, "bottom", b.level, options));
    top = build_top(memory, "top", scene.instances, bottoms, options);
  }
};

// Visits every leaf of a structure, by the format's own decoding.
template <class Visit>
void for_each_leaf(const mem::AddressSpace& memory, const NodeFormat& format, Address structure,
                   uint32_t block, Visit visit) {
  std::vector<DecodedChild> children(format.width());
  const uint32_t count =
      format.decode(memory.find(structure + Address(block) * kBlockBytes, format.node_bytes()), children);
  for (uint32_t i = 0; i < count; ++i) {
    const NodeRef ref = children[i].node;
    if (kind_of(ref) == NodeKind::Internal)
      for_each_leaf(memory, format, structure, block_of(ref), visit);
    else
      visit(kind_of(ref),
            memory.find(structure + Address(block_of(ref)) * kBlockBytes, leaf_bytes(kind_of(ref))));
  }
}

// Tests the candidates of one ray one by one. It was written anew from Vulkan's rules; only the arithmetic of
// a transform, of a box's entry and of a triangle is that of the unit, whose bits are compared.
class BruteForce {
 public:
  BruteForce(const Scene& scene, const BuiltScene& built) : scene_(scene) {
    for_each_leaf(built.memory, *find_format(built.top.format), built.top.address, kRootBlock,
                  [&](NodeKind, const std::byte* bytes) {
                    InstanceLeaf leaf;
                    std::memcpy(&leaf, bytes, sizeof leaf);
                    leaves_.push_back(leaf);
                  });
  }
  size_t num_instances() const { return leaves_.size(); }

  // Returns all hits that shaders and rules accept, nearest first, and of equals the lowest instance,
  // geometry, primitive.
  std::vector<Hit> hits(const Ray& ray) const {
    std::vector<Hit> out;
    for (const InstanceLeaf& leaf : leaves_) {
      if ((leaf.custom_index_and_mask >> 24 & ray.cull_mask & 0xff) == 0) continue;
      RaySpace space;
      enter(space, ray, leaf.world_to_object);
      const BottomScene& bottom = scene_.bottoms[scene_.instances[leaf.instance].bottom];
      for (uint32_t g = 0; g < bottom.level.geometries.size(); ++g)
        test(ray, leaf, space, bottom.level.geometries[g], g, out);
    }
    std::sort(out.begin(), out.end(), [](const Hit& a, const Hit& b) {
      return std::tuple(a.t, a.instance, a.geometry, a.primitive) <
             std::tuple(b.t, b.instance, b.geometry, b.primitive);
    });
    return out;
  }

 private:
  static void enter(RaySpace& space, const Ray& ray, const std::array<float, 12>& m) {
    std::array<float, 3> o, d;
    for (size_t r = 0; r < 3; ++r) {
      o[r] = ((m[4 * r] * ray.origin[0] + m[4 * r + 1] * ray.origin[1]) + m[4 * r + 2] * ray.origin[2]) +
             m[4 * r + 3];
      d[r] =
          (m[4 * r] * ray.direction[0] + m[4 * r + 1] * ray.direction[1]) + m[4 * r + 2] * ray.direction[2];
    }
    enter_space(space, o, d);
  }

  static void test(const Ray& ray, const InstanceLeaf& leaf, const RaySpace& space, const Geometry& geometry,
                   uint32_t g, std::vector<Hit>& out) {
    const uint32_t flags = leaf.sbt_offset_and_flags >> 24;
    bool opaque = geometry.opaque;
    if (flags & instance_flag::kForceOpaque) opaque = true;
    if (flags & instance_flag::kForceNoOpaque) opaque = false;
    if (ray.flags & ray_flag::kOpaque) opaque = true;
    if (ray.flags & ray_flag::kNoOpaque) opaque = false;
    if (ray.flags & (opaque ? ray_flag::kCullOpaque : ray_flag::kCullNoOpaque)) return;
    Hit hit;
    hit.instance = leaf.instance;
    hit.geometry = g;
    if (!geometry.aabbs.empty()) {
      if (ray.flags & ray_flag::kSkipAabbs) return;
      for (hit.primitive = 0; hit.primitive < geometry.aabbs.size(); ++hit.primitive)
        test_box(ray, space, geometry.aabbs[hit.primitive], opaque, hit, out);
    } else if (!(ray.flags & ray_flag::kSkipTriangles)) {
      const uint32_t count = uint32_t(geometry.positions.size() / 36);
      for (hit.primitive = 0; hit.primitive < count; ++hit.primitive)
        test_triangle(ray, flags, space, geometry, opaque, hit, out);
    }
  }

  static void test_triangle(const Ray& ray, uint32_t instance_flags, const RaySpace& space,
                            const Geometry& geometry, bool opaque, Hit hit, std::vector<Hit>& out) {
    std::array<std::array<float, 3>, 3> p;
    std::memcpy(&p, &geometry.positions[size_t(hit.primitive) * 36], 36);
    for (const auto& corner : p)
      for (float x : corner)
        if (!std::isfinite(x)) return;
    TriangleHit found;
    if (!intersect_triangle(space, p[0], p[1], p[2], found)) return;
    const bool front = found.front != ((instance_flags & instance_flag::kFlipFacing) != 0);
    const bool culled = ray.flags & (front ? ray_flag::kCullFrontFacing : ray_flag::kCullBackFacing);
    if (culled && !(instance_flags & instance_flag::kFacingCullDisable)) return;
    if (!(found.t > ray.t_min && found.t < ray.t_max)) return;
    if (!opaque && hit.primitive % 3 == 0) return;  // resolve()'s any-hit shader
    hit.t = found.t, hit.u = found.u, hit.v = found.v;
    hit.kind = front ? kHitKindFront : kHitKindBack;
    out.push_back(hit);
  }

  static void test_box(const Ray& ray, const RaySpace& space, const Bounds& box, bool opaque, Hit hit,
                       std::vector<Hit>& out) {
    if (!std::isfinite(box.low[0])) return;
    float t_near = -INFINITY, t_far = INFINITY;
    for (size_t a = 0; a < 3; ++a) {
      const bool backward = std::signbit(space.inverse_direction[a]);
      clip_slab(backward ? box.high[a] : box.low[a], backward ? box.low[a] : box.high[a], space.origin[a],
                space.inverse_direction[a], t_near, t_far);
    }
    const float enter = std::fmax(widen_near(t_near), ray.t_min),
                leave = std::fmin(widen_far(t_far), ray.t_max);
    if (!(enter <= leave)) return;
    hit.t = enter + 0.01f * float(hit.primitive % 5);  // resolve()'s intersection shader
    hit.kind = hit.primitive & 0x7f;
    if (!(hit.t <= ray.t_max)) return;
    if (!opaque && hit.primitive % 3 == 0) return;
    out.push_back(hit);
  }

  const Scene& scene_;
  std::vector<InstanceLeaf> leaves_;
};

// Returns maps that say what decide() says of `count` triangles, or that they do not know it. Some triangles
// are the same all over.
inline Micromaps maps_like_decide(Random& random, uint32_t count, const MicromapFormat& format) {
  Micromaps out{format, {}, {}};
  for (uint32_t primitive = 0; primitive < count; ++primitive) {
    const MicroState known = primitive % 3 ? MicroState::Opaque : MicroState::Transparent;
    const auto state = [&] {
      return format.two_states || random.below(2) ? known : MicroState(2 + random.below(2));
    };
    if (random.below(3) == 0) {
      out.index.push_back(Micromaps::uniform(state()));
      continue;
    }
    std::vector<uint8_t> map(format.bytes());
    for (uint32_t i = 0; i < format.num_states(); ++i) {
      const uint32_t bit = i * format.bits();
      map[bit / 8] = uint8_t(map[bit / 8] | uint32_t(state()) << bit % 8);
    }
    out.index.push_back(int32_t(out.states.size() / map.size()));
    out.states.insert(out.states.end(), map.begin(), map.end());
  }
  return out;
}

// Returns `closed` triangles that need shaders or have maps that know some of the answers, twice as many
// others, boxes, and instances that overlap.
inline Scene crowd(uint64_t seed, uint32_t closed) {
  Random random{seed};
  Scene out;
  BottomScene& all = out.bottoms.emplace_back();
  all.add_triangles(soup(random, 2 * closed, 10, 4), true);
  all.add_triangles(soup(random, closed, 10, 4), false);
  Random of_maps{seed + 1};
  all.add_micromaps(maps_like_decide(of_maps, closed, {false, uint32_t(seed % 5)}));
  std::vector<Bounds> boxes;
  for (int i = 0; i < 20; ++i) {
    const auto p = random.point(10);
    boxes.push_back({p, {p[0] + 1, p[1] + 2, p[2] + 1}});
  }
  all.add_boxes(boxes, false);
  for (int i = 0; i < 12; ++i) {
    Instance instance;
    instance.transform = random_transform(random, i % 2 ? 0.7f : -0.9f, 6);
    out.instances.push_back(instance);
  }
  return out;
}

}  // namespace glint::rt::test
