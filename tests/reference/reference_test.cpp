// Tests the reference renderer against hand-computed values, itself, and Embree's own triangle test.
// SPDX-License-Identifier: Apache-2.0
#include "tests/reference/reference.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/catch.h"

using namespace glint::reference;
using glint::scenes::load_scene;
using glint::scenes::RenderParams;
using glint::scenes::Scene;
using glint::scenes::Workload;

namespace {

RenderParams small(uint32_t side) {
  RenderParams params;
  params.width = params.height = side;
  return params;
}

ReferenceResult render_small(const Scene& scene, Workload workload, uint32_t side) {
  return render(scene, workload, small(side), *make_exact_intersector(scene));
}

}  // namespace

TEST_CASE("the generator and the hash have their known values") {
  uint32_t state = 1;
  CHECK(random_float(state) == float(1015568748u & 0xffffffu) / 16777216.0f);  // 1664525 + 1013904223
  CHECK(state == 1015568748u);
  // Numerical Recipes has this third value.
  CHECK(random_float(state) == float(1586005467u & 0xffffffu) / 16777216.0f);
  CHECK(hash_pair(0, 0) == 0x741c187du);  // computed once with arbitrary-precision integers
  CHECK(hash_pair(5, 7) == 0x697193aeu);
}

TEST_CASE("Woop's test finds the weights of a point inside a triangle") {
  Hit hit;
  const Ray ray{{0.25f, 0.5f, 3}, {0, 0, -1}, 0, 100};
  REQUIRE(meets_triangle(ray, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, hit));
  CHECK(hit.t == 3);
  CHECK(hit.u == 0.25f);
  CHECK(hit.v == 0.5f);
  CHECK_FALSE(meets_triangle({{0.75f, 0.5f, 3}, {0, 0, -1}, 0, 100}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, hit));
}

TEST_CASE("a ray through a shared edge meets at least one of its two triangles") {
  std::mt19937 engine(3);
  const auto draw = [&engine] { return float(engine() % 2000) / 1000.0f - 1; };
  for (int i = 0; i < 20000; ++i) {
    const Vec a(draw(), draw(), 0), b(draw(), draw(), 0), left(-3, draw(), draw()), right(3, draw(), draw());
    const Vec origin(draw(), draw(), 4);
    const Ray ray{origin, a + (b - a) * (0.1f + 0.8f * std::abs(draw())) - origin, 0, 100};
    // `left` and `right` lie on either side of the edge as the ray sees it.
    Hit hit;
    const auto side = [&](const Vec& p) {
      const Vec e = b - a, q = p - a;
      const Vec n(e.y * ray.direction.z - e.z * ray.direction.y,
                  e.z * ray.direction.x - e.x * ray.direction.z,
                  e.x * ray.direction.y - e.y * ray.direction.x);
      return dot(n, q);
    };
    if (side(left) * side(right) > -1e-2f || length(b - a) < 0.1f) continue;
    REQUIRE((meets_triangle(ray, a, b, left, hit) || meets_triangle(ray, b, a, right, hit)));
  }
}

TEST_CASE("a sphere is entered in front, left from inside, and never hit beyond the interval") {
  CHECK(meets_sphere({{0, 0, 5}, {0, 0, -1}, 0.001f, 100}, {0, 0, 0}, 1) == 4);
  CHECK(meets_sphere({{0, 0, 0}, {0, 0, -2}, 0.001f, 100}, {0, 0, 0}, 1) == 0.5f);
  CHECK(meets_sphere({{0, 0, 5}, {0, 0, -1}, 0.001f, 4}, {0, 0, 0}, 1) < 0);
  CHECK(meets_sphere({{0, 2, 5}, {0, 0, -1}, 0.001f, 100}, {0, 0, 0}, 1) < 0);
}

TEST_CASE("two renders of one scene are equal bit for bit") {
  const Scene scene = load_scene("WKND", {});
  const ReferenceResult a = render_small(scene, Workload::PathTracing, 24);
  const ReferenceResult b = render_small(scene, Workload::PathTracing, 24);
  CHECK(a.rays == b.rays);
  for (size_t i = 0; i < a.sum.size(); ++i)
    REQUIRE((a.sum[i].x == b.sum[i].x && a.sum[i].y == b.sum[i].y && a.sum[i].z == b.sum[i].z));
}

TEST_CASE("ray counts keep to the workloads' limits and add up over the pixels") {
  const Scene scene = load_scene("CORNELL", {});
  const struct {
    Workload workload;
    uint32_t least, most;
  } limits[] = {
      {Workload::PathTracing, 2, 32}, {Workload::Shadow, 2, 6}, {Workload::AmbientOcclusion, 2, 10}};
  for (const auto& limit : limits) {
    const ReferenceResult result = render_small(scene, limit.workload, 32);
    uint64_t sum = 0;
    uint32_t most = 0;
    for (const uint32_t rays : result.rays_of_pixel) {
      REQUIRE((limit.least <= rays && rays <= limit.most));
      sum += rays;
      most = std::max(most, rays);
    }
    CHECK(sum == result.rays);
    CHECK(most == limit.most);
  }
}

TEST_CASE("a ray that misses indoors is black and outdoors has the sky's colour") {
  Scene scene = load_scene("CORNELL", {});
  scene.camera.target = {278, 278, 2000};  // away from the box
  const ReferenceResult dark = render_small(scene, Workload::PathTracing, 4);
  CHECK(dark.rays == 32);
  for (const Vec& c : dark.sum) CHECK((c.x == 0 && c.y == 0 && c.z == 0));
  scene.camera.has_sky = true;
  const ReferenceResult sky = render_small(scene, Workload::Shadow, 4);
  for (const Vec& c : sky.mean) {
    CHECK(c.z == Approx(1));  // blue is 1 at every height
    CHECK((c.x > 0.5f && c.x < 1));
  }
  CHECK(sky.mean[0].x < sky.mean[15].x);  // row 0 is the top, where the sky is bluer
}

TEST_CASE("the exact test and Embree's agree on nearly every ray of a detailed scene") {
  const Scene scene = load_scene("BUNNY", {});
  const auto exact = make_exact_intersector(scene), embree = make_embree_intersector(scene);
  std::mt19937 engine(11);
  const auto draw = [&engine](float scale) { return scale * (float(engine() >> 8) / 16777216.0f); };
  int same = 0;
  constexpr int kRays = 20000;
  for (int i = 0; i < kRays; ++i) {
    const Vec origin(278, 278, 800);
    const Ray ray{origin, Vec(draw(555), draw(555), -draw(555)) - origin, 0.001f, 10000};
    const Hit a = exact->closest(ray), b = embree->closest(ray);
    REQUIRE(a.missed() == b.missed());
    if (a.missed()) continue;
    REQUIRE(a.t == Approx(b.t).epsilon(1e-4));
    same += a.model == b.model && a.primitive == b.primitive;
  }
  CHECK(same > kRays * 99 / 100);
}

TEST_CASE("equal distances go to the lowest model and primitive") {
  Scene scene = load_scene("CORNELL", {});
  scene.models.push_back(scene.models[0]);
  const Hit hit =
      make_exact_intersector(scene)->closest({{278, 278, 800}, {0.03f, 0.01f, -1}, 0.001f, 10000});
  CHECK(hit.model == 0);
}
