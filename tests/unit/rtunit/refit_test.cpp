// Tests fitted structures: their hits are those of structures that were built, and their boxes hold
// everything.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/structure/refit.h"

#include <cstring>
#include <numeric>
#include <string>
#include <vector>

#include "base/registry.h"
#include "rtunit/node_format.h"
#include "rtunit/structure/cost.h"
#include "rtunit/structure/micromaps.h"
#include "rtunit/structure/validate.h"
#include "rtunit/tree_layout.h"
#include "tests/support/catch.h"
#include "tests/support/rt_scenes.h"

namespace glint::rt::test::refit_test {
namespace {

// Returns a sheet of n x n quads, whose triangles share leaves.
Positions sheet(uint32_t n, std::vector<uint32_t>& indices) {
  Positions out;
  for (uint32_t y = 0; y <= n; ++y)
    for (uint32_t x = 0; x <= n; ++x) out.push_back({float(x), float(y), 0});
  for (uint32_t y = 0; y < n; ++y)
    for (uint32_t x = 0; x < n; ++x) {
      const uint32_t a = y * (n + 1) + x, b = a + n + 1;
      indices.insert(indices.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
  return out;
}

Positions waved(const Positions& rest, float time) {
  Positions out = rest;
  for (auto& p : out)
    p[2] += 2 * std::sin(p[0] * 0.7f + time) * std::cos(p[1] * 0.4f), p[0] += 0.3f * time * p[1];
  return out;
}

std::span<std::byte> bytes_of(const mem::AddressSpace& memory, const StructureInfo& info) {
  return memory.view<std::byte>(info.address, info.bytes);
}

// A bottom level that was built with its tree, below a top level of three instances that also has its tree.
struct Fitted {
  mem::AddressSpace memory;
  BuildOptions options;
  KeptTree bottom_tree, top_tree;
  StructureInfo bottom, top;
  std::vector<Instance> instances;

  Fitted(const BottomLevel& level, const BuildOptions& chosen, std::vector<Instance> placed)
      : options(chosen), instances(std::move(placed)) {
    bottom = place(memory, "b", encode_bottom("b", level, options, 1, &bottom_tree));
    top = place(memory, "t", encode_top("t", instances, std::vector{bottom}, options, nullptr, &top_tree));
  }
  void fit(const BottomLevel& level, std::vector<Instance> placed, uint32_t threads = 1) {
    instances = std::move(placed);
    REQUIRE(refit_bottom(bottom_tree, level, bytes_of(memory, bottom), threads) == "");
    bottom.bounds = bottom_tree.info.bounds;
    REQUIRE(refit_top(top_tree, instances, std::vector{bottom}, bytes_of(memory, top)) == "");
    top.bounds = top_tree.info.bounds;
  }
};

std::vector<Instance> placed(float time) {
  Random random{5};
  std::vector<Instance> out(3);
  for (uint32_t i = 0; i < 3; ++i) {
    out[i].transform = random_transform(random, 1 + 0.2f * float(i), 10);
    out[i].transform[3] += time * float(i) * 6, out[i].transform[11] -= time * 3;
  }
  return out;
}

void check_same_hits(const mem::AddressSpace& a, Address top_a, const mem::AddressSpace& b, Address top_b,
                     uint32_t rays, uint32_t least_hits) {
  Random random{77};
  uint32_t hits = 0;
  for (uint32_t i = 0; i < rays; ++i) {
    const auto origin = random.point(40), to = random.point(12);
    RayState one = ray_of(top_a, origin, {to[0] - origin[0], to[1] - origin[1], to[2] - origin[2]}),
             other = one;
    other.ray.structure = top_b;
    REQUIRE(begin(one, a));
    REQUIRE(begin(other, b));
    run(one, a);
    run(other, b);
    REQUIRE(std::memcmp(&one.committed.t, &other.committed.t, sizeof one.committed.t) == 0);
    CHECK(one.committed.primitive == other.committed.primitive);
    CHECK(one.committed.instance == other.committed.instance);
    CHECK(std::memcmp(&one.committed.u, &other.committed.u, sizeof one.committed.u) == 0);
    CHECK(std::memcmp(&one.committed.v, &other.committed.v, sizeof one.committed.v) == 0);
    hits += one.committed.t < 1e30f;
  }
  CHECK(hits >= least_hits);
}

TEST_CASE("in every node format and layout a fitted structure is sound and has the hits of a built one") {
  std::vector<uint32_t> indices;
  const Positions rest = sheet(24, indices);
  Geometry geometry = triangles(rest);
  geometry.indices = indices;
  for (const std::string& format : Registry<NodeFormat>::names())
    for (const std::string& layout : Registry<TreeLayout>::names()) {
      CAPTURE(format, layout);
      const BuildOptions options{format.c_str(), true, layout.c_str()};
      Fitted fitted({{geometry}}, options, placed(0));
      for (const float time : {0.5f, 2.0f}) {
        const Positions now = waved(rest, time);
        Geometry moved = geometry;
        moved.positions = std::as_bytes(std::span(now));
        fitted.fit({{moved}}, placed(time), time > 1 ? 3 : 1);
        CHECK(validate(fitted.memory, fitted.top.address).empty());
        const Fitted built({{moved}}, options, placed(time));
        CHECK(fitted.bottom.bounds == built.bottom.bounds);
        CHECK(fitted.top.bounds == built.top.bounds);
        check_same_hits(fitted.memory, fitted.top.address, built.memory, built.top.address, 400, 40);
      }
    }
}

TEST_CASE("fitting to where everything was when it was built changes no byte") {
  Random random{3};
  const Positions positions = soup(random, 3000, 10, 1);
  const std::vector<Bounds> boxes{{{5, 5, 5}, {6, 6, 6}}, {{NAN, 0, 0}, {1, 1, 1}}, {{7, 5, 5}, {8, 6, 6}}};
  Geometry procedural;
  procedural.aabbs = boxes;
  const BottomLevel level{{triangles(positions), procedural}};
  for (const std::string& format : Registry<NodeFormat>::names()) {
    CAPTURE(format);
    Fitted fitted(level, {format.c_str()}, placed(0));
    const auto bottom = bytes_of(fitted.memory, fitted.bottom), top = bytes_of(fitted.memory, fitted.top);
    const std::vector<std::byte> bottom_was(bottom.begin(), bottom.end()), top_was(top.begin(), top.end());
    fitted.fit(level, placed(0));
    CHECK(std::equal(bottom_was.begin(), bottom_was.end(), bottom.begin()));
    CHECK(std::equal(top_was.begin(), top_was.end(), top.begin()));
  }
}

TEST_CASE("a fitted structure keeps its micromaps") {
  std::vector<uint32_t> indices;
  const Positions rest = sheet(4, indices);
  Micromaps maps;
  maps.format = {.two_states = true, .level = 1};
  maps.states.assign(maps.format.bytes() * 2, 0x5);
  for (uint32_t i = 0; i < indices.size() / 3; ++i) maps.index.push_back(int32_t(i % 2));
  Geometry geometry = triangles(rest, false);
  geometry.indices = indices, geometry.micromaps = &maps;
  Fitted fitted({{geometry}}, {}, placed(0));
  const auto header = fitted.memory.view<StructureHeader>(fitted.bottom.address, 1)[0];
  REQUIRE(header.micromaps > 0);
  const auto table = bytes_of(fitted.memory, fitted.bottom).subspan(size_t{header.micromaps} * kBlockBytes);
  const std::vector<std::byte> was(table.begin(), table.end());
  const Positions now = waved(rest, 1);
  geometry.positions = std::as_bytes(std::span(now));
  geometry.micromaps = nullptr;  // They follow the triangles, wherever these are.
  fitted.fit({{geometry}}, placed(1));
  CHECK(std::equal(was.begin(), was.end(), table.begin()));
  CHECK(validate(fitted.memory, fitted.top.address).empty());
}

TEST_CASE("input that the tree does not fit is refused, and the structure stays") {
  std::vector<uint32_t> indices;
  Positions rest = sheet(4, indices);
  Geometry geometry = triangles(rest);
  geometry.indices = indices;
  Fitted fitted({{geometry}}, {}, placed(0));
  const auto bytes = bytes_of(fitted.memory, fitted.bottom);
  const std::vector<std::byte> was(bytes.begin(), bytes.end());
  const auto refused = [&](const BottomLevel& level) {
    const std::string why = refit_bottom(fitted.bottom_tree, level, bytes);
    CHECK(std::equal(was.begin(), was.end(), bytes.begin()));
    return why;
  };
  Geometry fewer = geometry;
  fewer.indices = std::span(indices).first(indices.size() - 3);
  CHECK(refused({{fewer}}) == "triangle 31 of geometry 0 is gone or is not finite");
  std::vector<uint32_t> more_indices = indices;
  more_indices.insert(more_indices.end(), {0, 1, 6});
  Geometry more = geometry;
  more.indices = more_indices;
  CHECK(refused({{more}}) == "triangle 32 of geometry 0 was inactive when it was built");
  std::vector<uint32_t> torn = indices;
  torn[3] = 24;  // a corner of the second triangle of the first quad
  Geometry split = geometry;
  split.indices = torn;
  CHECK(refused({{split}}) == "triangle 1 of geometry 0 has left the triangle with which it shares a leaf");
  rest[3][1] = NAN;
  CHECK(refused({{geometry}}) == "triangle 6 of geometry 0 is gone or is not finite");
  rest[3][1] = 0;
  CHECK(refused({{geometry}}) == "");
  // An instance that is flat is inactive, so the tree over the others is another one.
  std::vector<Instance> flat = placed(0);
  flat[1].transform.fill(0);
  CHECK(refit_top(fitted.top_tree, flat, std::vector{fitted.bottom}, bytes_of(fitted.memory, fitted.top)) ==
        "another number of instances is active");
}

TEST_CASE("a triangle that loses its area stays in the tree, and comes back") {
  Random random{3};
  const Positions positions = soup(random, 50, 10, 3);
  Fitted fitted({{triangles(positions)}}, {}, placed(0));
  const auto bytes = bytes_of(fitted.memory, fitted.bottom);
  const std::vector<std::byte> was(bytes.begin(), bytes.end());
  Positions flat = positions;
  flat[31] = flat[32] = flat[30];
  fitted.fit({{triangles(flat)}}, placed(0));
  const Fitted built({{triangles(flat)}}, {}, placed(0));
  CHECK(built.bottom.primitives == 49);
  check_same_hits(fitted.memory, fitted.top.address, built.memory, built.top.address, 400, 40);
  fitted.fit({{triangles(positions)}}, placed(0));
  CHECK(std::equal(was.begin(), was.end(), bytes.begin()));
}

TEST_CASE("a triangle that was inactive cannot join by fitting") {
  Random random{3};
  const Positions positions = soup(random, 50, 10, 3);
  Positions flat = positions;
  flat[31] = flat[32] = flat[30];
  Fitted fitted({{triangles(flat)}}, {}, placed(0));
  CHECK(refit_bottom(fitted.bottom_tree, {{triangles(positions)}}, bytes_of(fitted.memory, fitted.bottom)) ==
        "triangle 10 of geometry 0 was inactive when it was built");
}

TEST_CASE("the cost of a structure is the sum of its boxes' areas over the root's") {
  // Two unit cubes at the ends of a box of 10 x 1 x 1: half areas 3, 3 and 21.
  const std::vector<Bounds> boxes{{{0, 0, 0}, {1, 1, 1}}, {{9, 0, 0}, {10, 1, 1}}};
  Geometry procedural;
  procedural.aabbs = boxes;
  mem::AddressSpace memory;
  const StructureInfo info = build_bottom(memory, "b", {{procedural}}, {"bvh2"});
  CHECK(expected_visits(bytes_of(memory, info)) == Approx(1 + 6.0 / 21));
  const StructureInfo top = build_top(memory, "t", std::vector<Instance>(1), std::vector{info}, {"bvh2"});
  CHECK(expected_visits(bytes_of(memory, top)) == Approx(2));
  CHECK(expected_visits(bytes_of(memory, top), [&](Address) { return 5.0; }) == Approx(7));
}

TEST_CASE("fitting to geometry that mixes costs more than building anew") {
  Random random{9};
  const Positions near = soup(random, 2000, 20, 0.5f);
  Fitted fitted({{triangles(near)}}, {}, placed(0));
  const double before = expected_visits(bytes_of(fitted.memory, fitted.bottom));
  Positions mixed = near;
  for (size_t i = 0; i < mixed.size(); i += 3) {
    const float d = (i / 3) % 2 ? 15.0f : -15.0f;
    for (size_t c = 0; c < 3; ++c) mixed[i + c][0] += d;
  }
  fitted.fit({{triangles(mixed)}}, placed(0));
  mem::AddressSpace memory;
  const double built = expected_visits(bytes_of(memory, build_bottom(memory, "b", {{triangles(mixed)}})));
  const double after = expected_visits(bytes_of(fitted.memory, fitted.bottom));
  CHECK(after > 1.5 * built);
  CHECK(after > before);
}

}  // namespace
}  // namespace glint::rt::test::refit_test
