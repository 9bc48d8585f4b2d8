// Tests that closest hits of random scenes agree with Embree's own intersector.
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/embree.h"

#include <array>
#include <cstring>

#include "rtunit/structure/validate.h"
#include "tests/support/catch.h"
#include "tests/support/rt_scenes.h"

namespace glint::rt::test {
namespace {

struct Part {
  Positions positions;
  std::array<float, 12> transform;
};

std::array<float, 3> transformed(const std::array<float, 12>& m, const std::array<float, 3>& p) {
  std::array<float, 3> out;
  for (size_t r = 0; r < 3; ++r)
    out[r] = ((m[4 * r] * p[0] + m[4 * r + 1] * p[1]) + m[4 * r + 2] * p[2]) + m[4 * r + 3];
  return out;
}

// Holds Embree's scene, with one instance for each part.
class Oracle {
 public:
  explicit Oracle(const std::vector<Part>& parts) {
    device_ = rtcNewDevice("threads=1,ignore_config_files=1");
    scene_ = rtcNewScene(device_);
    for (const Part& part : parts) {
      RTCScene object = rtcNewScene(device_);
      rtcSetSceneFlags(object, RTC_SCENE_FLAG_ROBUST);
      RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
      void* v = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12,
                                        part.positions.size());
      std::memcpy(v, part.positions.data(), part.positions.size() * 12);
      auto* i = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
          mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, part.positions.size() / 3));
      for (uint32_t k = 0; k < part.positions.size(); ++k) i[k] = k;
      rtcCommitGeometry(mesh);
      rtcAttachGeometry(object, mesh);
      rtcReleaseGeometry(mesh);
      rtcCommitScene(object);
      RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(instance, object);
      rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, part.transform.data());
      rtcCommitGeometry(instance);
      rtcAttachGeometry(scene_, instance);
      rtcReleaseGeometry(instance);
      rtcReleaseScene(object);
    }
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene_);
  }
  ~Oracle() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  RTCRayHit intersect(const Ray& ray) const {
    RTCRayHit out{};
    out.ray = {ray.origin[0],
               ray.origin[1],
               ray.origin[2],
               ray.t_min,
               ray.direction[0],
               ray.direction[1],
               ray.direction[2],
               0,
               ray.t_max,
               ~0u,
               0,
               0};
    out.hit.geomID = out.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    glint::test::EmbreeContext context;
    glint::test::start(context);
    glint::test::intersect(scene_, context, out);
    return out;
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

struct Comparison {
  // A ray is decided when the results differ and exact arithmetic finds no fault.
  uint32_t hits = 0, misses = 0, same = 0, decided = 0, wrong = 0;
};

// Holds the hit of one triangle in double precision, and how far float rounding may move it. `blur` grows for
// grazing rays and for slivers, relative to the scene's size and the triangle's.
struct Exact {
  double t = 0, margin = 0, blur = 0;
};
Exact exact_hit(const Ray& ray, const Part& part, uint32_t primitive) {
  double p[3][3], e1[3], e2[3], n[3], s[3], q[3], reach = 0;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) {
      const auto& v = part.positions[3 * primitive + uint32_t(c)];
      const auto& m = part.transform;
      p[c][r] = m[size_t(4 * r + 3)];
      for (int k = 0; k < 3; ++k) p[c][r] += double(m[size_t(4 * r + k)]) * v[size_t(k)];
      reach = std::fmax(reach, std::fmax(std::fabs(p[c][r]), std::fabs(ray.origin[size_t(r)])));
    }
  for (int r = 0; r < 3; ++r)
    e1[r] = p[1][r] - p[0][r], e2[r] = p[2][r] - p[0][r], s[r] = ray.origin[size_t(r)] - p[0][r];
  const auto& d = ray.direction;
  const auto cross = [](const double* a, const double* b, double* out) {
    for (int r = 0; r < 3; ++r) out[r] = a[(r + 1) % 3] * b[(r + 2) % 3] - a[(r + 2) % 3] * b[(r + 1) % 3];
  };
  const auto length = [](const double* a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); };
  const double dd[3] = {d[0], d[1], d[2]};
  cross(e1, e2, n);
  cross(s, dd, q);
  const double det = -(n[0] * dd[0] + n[1] * dd[1] + n[2] * dd[2]);
  const double u = (e2[0] * q[0] + e2[1] * q[1] + e2[2] * q[2]) / det;
  const double v = -(e1[0] * q[0] + e1[1] * q[1] + e1[2] * q[2]) / det;
  Exact out;
  out.t = (n[0] * s[0] + n[1] * s[1] + n[2] * s[2]) / det;
  out.margin = std::fmin(std::fmin(u, v), 1 - u - v);
  const double longest = std::fmax(length(e1), length(e2));
  const double height = length(n) / longest, sine = std::fabs(det) / (length(n) * length(dd));
  out.blur = 32 * 0x1p-24 * reach / (std::fmin(height, longest) * sine);  // in weights
  return out;
}

// Returns the rounding of t: the weights' blur times the triangle's extent along the ray is bounded by reach
// / (|d| sine).
double t_blur(const Exact& e, const Ray& ray, float size) {
  double d = 0;
  for (float x : ray.direction) d += double(x) * x;
  return e.blur * size / std::sqrt(d) + 1e-5 * std::fabs(e.t);
}

void compare(const Hit& ours, const RTCRayHit& theirs, const Ray& ray, const std::vector<Part>& parts,
             float size, Comparison& c) {
  const bool hit = theirs.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  ++(ours.valid() ? c.hits : c.misses);
  const bool same_primitive =
      ours.valid() && hit && ours.instance == theirs.hit.instID[0] && ours.primitive == theirs.hit.primID;
  if ((!hit && !ours.valid()) ||
      (same_primitive && std::fabs(ours.t - theirs.ray.tfar) <= 1e-5f * std::fabs(ours.t))) {
    ++c.same;
    return;
  }
  bool wrong = false;
  Exact a, b;
  if (ours.valid()) {  // ours must be a hit
    a = exact_hit(ray, parts[ours.instance], ours.primitive);
    wrong |= a.margin < -a.blur || std::fabs(a.t - ours.t) > t_blur(a, ray, size);
  }
  if (hit && !same_primitive) {  // theirs must not be nearer, unless rounding may lose it
    b = exact_hit(ray, parts[theirs.hit.instID[0]], theirs.hit.primID);
    const double blur = t_blur(b, ray, size) + (ours.valid() ? t_blur(a, ray, size) : 0);
    wrong |= b.margin > b.blur && b.t + blur < (ours.valid() ? ours.t : ray.t_max);
  }
  ++(wrong ? c.wrong : c.decided);
}

Comparison run_scene(uint64_t seed, uint32_t num_parts, uint32_t count, float size, float edge,
                     uint32_t num_rays, bool identity) {
  Random random{seed};
  std::vector<Part> parts;
  mem::AddressSpace memory;
  std::vector<StructureInfo> bottoms;
  std::vector<Instance> instances;
  for (uint32_t p = 0; p < num_parts; ++p) {
    const float scale = random.uniform(0.2f, 2) * (random.below(2) ? 1.f : -1.f);
    parts.push_back(
        {soup(random, count, size, edge), identity ? kIdentity : random_transform(random, scale, size)});
    bottoms.push_back(build_bottom(memory, "bottom", {{triangles(parts.back().positions)}}));
    instances.emplace_back();
    instances.back().transform = parts.back().transform;
    instances.back().bottom = p;
  }
  const StructureInfo top = build_top(memory, "top", instances, bottoms);
  const auto errors = validate(memory, top.address);
  CAPTURE(seed, errors.empty() ? "" : errors.front());
  CHECK(errors.empty());
  const Oracle oracle(parts);
  Comparison result;
  for (uint32_t i = 0; i < num_rays; ++i) {
    const Part& part = parts[random.below(num_parts)];
    const size_t triangle = random.below(count);
    auto origin = random.point(1.5f * size), target = random.point(size);
    std::array<float, 3> direction;
    if (i % 4) {  // most rays aim at a triangle, some of them at an edge or a vertex
      float a = random.uniform(0, 1), b = random.uniform(0, 1 - a);
      if (i % 16 == 1) a = 0;
      if (i % 16 == 5) a = b = 0;
      std::array<float, 3> p;
      for (size_t k = 0; k < 3; ++k) {
        const auto& v = &part.positions[3 * triangle];
        p[k] = v[0][k] * (1 - a - b) + v[1][k] * a + v[2][k] * b;
      }
      target = transformed(part.transform, p);
    }
    for (size_t k = 0; k < 3; ++k) direction[k] = target[k] - origin[k];
    if (i % 8 == 2) {  // along an axis, through the target
      const size_t axis = random.below(3);
      for (size_t k = 0; k < 3; ++k)
        if (k != axis) origin[k] = target[k], direction[k] = 0;
    }
    RayState state = ray_of(top.address, origin, direction, 0, i % 3 ? INFINITY : 0.9f);
    REQUIRE(begin(state, memory));
    run(state, memory);
    REQUIRE(state.status == RayStatus::Done);
    compare(state.committed, oracle.intersect(state.ray), state.ray, parts, size, result);
  }
  return result;
}

TEST_CASE("rays on random soups hit what Embree's robust intersector hits") {
  Comparison sum;
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    const uint32_t count = uint32_t(1) << (seed % 11);
    const Comparison c = run_scene(seed, 1, count, 10, seed % 3 ? 3.f : 0.5f, 1500, true);
    CAPTURE(seed, c.wrong, c.decided, c.same);
    CHECK(c.wrong == 0);
    CHECK(c.decided <= 75);  // of the 187 rays that aim at an edge or a vertex, half may fall on either side
    sum.hits += c.hits, sum.misses += c.misses;
  }
  CHECK(sum.hits > 20000);  // the test has teeth, because both outcomes are frequent
  CHECK(sum.misses > 5000);
}

TEST_CASE("rays hit mirrored, scaled and rotated instances as Embree's do") {
  for (uint64_t seed = 100; seed < 130; ++seed) {
    const Comparison c = run_scene(seed, 1 + uint32_t(seed % 40), 40, 10, 2, 1500, false);
    CAPTURE(seed, c.wrong, c.decided, c.same);
    CHECK(c.wrong == 0);
    CHECK(c.decided <= 75);
    CHECK(c.hits > 300);
  }
}

// Beyond these sizes the oracle's own products overflow or vanish.
TEST_CASE("very large and very small coordinates hit as Embree's do") {
  for (float size : {1e-6f, 1e-3f, 1e4f, 1e8f}) {
    const Comparison c = run_scene(7, 1, 300, size, size / 4, 3000, true);
    CAPTURE(size, c.wrong, c.decided, c.same);
    CHECK(c.wrong == 0);
    CHECK(c.decided <= 150);
    CHECK(c.hits > 1000);
  }
}

}  // namespace
}  // namespace glint::rt::test
