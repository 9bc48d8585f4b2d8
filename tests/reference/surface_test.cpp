// Tests the reference's textures, holes and moved copies against hand-computed values.
// SPDX-License-Identifier: Apache-2.0
#include "tests/reference/surface.h"

#include <cstdint>

#include "tests/reference/texture.h"
#include "tests/support/catch.h"

using namespace glint::reference;
namespace scenes = glint::scenes;

namespace {

// Returns two texels side by side: black without alpha, and white.
scenes::Texture two_texels() {
  return {"two", 2, 1, {0, 0, 0, 0, 255, 255, 255, 255}};
}

// Returns a right triangle with that texture at z = 0, and the same triangle in plain white at z = -1.
scenes::Scene two_triangles() {
  scenes::Scene scene;
  scene.alpha_test = true;
  scene.textures.push_back(two_texels());
  scene.materials.resize(2);
  scene.materials[0].texture = 0;
  for (const int32_t material : {0, 1}) {
    scenes::Model model;
    const float z = -float(material);
    model.vertices = {{{0, 0, z}, {0, 0, 1}, {0, 0}, material},
                      {{1, 0, z}, {0, 0, 1}, {1, 0}, material},
                      {{0, 1, z}, {0, 0, 1}, {0, 1}, material}};
    model.indices = {0, 1, 2};
    scene.models.push_back(model);
  }
  return scene;
}

}  // namespace

TEST_CASE("a texture has its texels' colours at their centres and the mean between them") {
  const scenes::Texture texture = two_texels();
  CHECK(sample(texture, 0.25f, 0.5f)[0] == 0.0f);
  CHECK(sample(texture, 0.75f, 0.5f)[0] == 1.0f);
  CHECK(sample(texture, 0.5f, 0.5f)[0] == 0.5f);
  CHECK(sample(texture, 0.625f, 0.5f)[3] == 0.75f);
}

TEST_CASE("a coordinate outside of a texture has its edge's colour, or its other side's where it repeats") {
  scenes::Texture texture = two_texels();
  CHECK(sample(texture, 1.25f, 9)[0] == 1.0f);
  CHECK(sample(texture, -7, -9)[0] == 0.0f);
  CHECK(sample(texture, 0, 0.5f)[0] == 0.0f);
  texture.repeat = true;
  CHECK(sample(texture, 1.25f, 9)[0] == 0.0f);
  CHECK(sample(texture, -0.25f, -9)[0] == 1.0f);
  CHECK(sample(texture, 0, 0.5f)[0] == 0.5f);  // half of the last texel
}

TEST_CASE("the four texels around a point weigh by their distance on both axes") {
  const scenes::Texture texture{"four", 2, 2, {0, 0, 0, 255, 255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255}};
  const scenes::Vec4 color = sample(texture, 0.25f + 0.5f * 0.25f, 0.25f + 0.5f * 0.5f);
  CHECK(color == scenes::Vec4{0.25f * 0.5f, 0.75f * 0.5f, 0.25f * 0.5f, 1});
}

TEST_CASE("sRGB colours become linear before they are mixed, and alpha is linear already") {
  scenes::Texture texture{"grey", 2, 1, {128, 10, 0, 128, 128, 10, 255, 128}};
  CHECK(sample(texture, 0.5f, 0.5f)[0] == Approx(128 / 255.0));
  texture.srgb = true;
  const scenes::Vec4 color = sample(texture, 0.5f, 0.5f);
  CHECK(color[0] == Approx(0.2158605));           // ((128 / 255 + 0.055) / 1.055) ^ 2.4
  CHECK(color[1] == Approx(10 / 255.0 / 12.92));  // the straight part
  CHECK(color[2] == Approx(0.5));                 // the mean of 0 and 1, not the value of 127.5
  CHECK(color[3] == Approx(128 / 255.0));
}

TEST_CASE("rays that are not opaque pass holes and nothing else, in both intersectors") {
  const scenes::Scene scene = two_triangles();
  const bool exact = GENERATE(false, true);
  const auto intersector = exact ? make_exact_intersector(scene) : make_embree_intersector(scene);
  Ray left{{0.125f, 0.25f, 1}, {0, 0, -1}, 0, 100}, middle{{0.375f, 0.25f, 1}, {0, 0, -1}, 0, 100};

  CHECK(intersector->closest(left).model == 0);
  left.opaque = middle.opaque = false;
  CHECK(intersector->closest(left).model == 1);
  CHECK(intersector->closest(left).t == Approx(2));  // Embree's last bits depend on the processor.
  CHECK(intersector->closest(middle).model == 0);    // alpha 0.25 is not a hole
}

TEST_CASE("a mirrored and stretched instance is moved with normals that stay at right angles to it") {
  scenes::Scene scene = two_triangles();
  scene.models[0].vertices[0].normal = {0, 0.6f, 0.8f};
  // The matrix doubles x, swaps y and z (a mirror image), then moves.
  scene.instances = {{1, scenes::kIdentity}, {0, {2, 0, 0, 10, 0, 0, 1, 20, 0, 1, 0, 30}}};
  const scenes::Scene flat = flattened(scene);

  REQUIRE(flat.models.size() == 2);
  CHECK(flat.instances.empty());
  CHECK(flat.models[0].vertices[1].position == scenes::Vec3{1, 0, -1});
  CHECK(flat.models[1].vertices[1].position == scenes::Vec3{12, 20, 30});
  CHECK(flat.models[1].vertices[2].position == scenes::Vec3{10, 20, 31});
  const scenes::Vec3 normal = flat.models[1].vertices[0].normal;
  CHECK(normal[1] == Approx(0.8f));
  CHECK(normal[2] == Approx(0.6f));
  CHECK(flat.models[1].vertices[1].normal[1] == Approx(1));
}
