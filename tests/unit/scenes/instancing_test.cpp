// Tests that affine copies are found where they are, and nowhere else.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/instancing.h"

#include <array>
#include <cmath>
#include <utility>

#include "scenes/import/asset_folder.h"
#include "scenes/mesh.h"
#include "tests/support/catch.h"

namespace {

using namespace glint::scenes;

// Returns a lopsided pyramid, which has no symmetry, so that only one matrix moves it onto a copy.
Model pyramid() {
  Model model;
  add_vertex(model, {0, 0, 0}, {}, 0, {0, 0});
  add_vertex(model, {2, 0, 0}, {}, 0, {1, 0});
  add_vertex(model, {0, 3, 0}, {}, 0, {0, 1});
  add_vertex(model, {0, 0, 5}, {}, 0, {1, 1});
  for (const auto& t : {std::array<uint32_t, 3>{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}})
    add_triangle(model, t[0], t[1], t[2]);
  compute_smooth_normals(model);
  return model;
}

// Shears, scales unevenly, mirrors and moves.
constexpr Affine kMatrix{0, 2, 0.5f, 10, 3, 0, 0, -20, 0.25f, 0, 1, 30};

Model moved(const Model& model, const Affine& matrix) {
  Model out;
  append_copy(out, model, matrix, -1);
  return out;
}

Scene scene_of(std::vector<Model> models) {
  Scene scene;
  scene.materials.resize(3);
  scene.materials[2].diffuse = {1, 0, 0, 1};  // materials 0 and 1 are equal
  scene.models = std::move(models);
  return scene;
}

}  // namespace

TEST_CASE("the matrix between a body and its copy is the one that moved it") {
  const auto found = affine_between(pyramid(), moved(pyramid(), kMatrix));
  REQUIRE(found);
  for (size_t i = 0; i < 12; ++i) CHECK(std::fabs((*found)[i / 4][i % 4] - kMatrix[i / 4][i % 4]) < 1e-5f);
}

TEST_CASE("the matrix of a turned copy has exact zeros, so that its upright walls stay upright") {
  Model copy = pyramid();
  Placement placement;
  placement.translation = {12.3f, 4.5f, -67.8f};
  placement.rotation_y = 33;
  placement.scale = 1.7f;
  place(copy, placement);
  const auto found = affine_between(pyramid(), copy);
  REQUIRE(found);
  for (const auto& [row, column] : {std::pair<size_t, size_t>{1, 0}, {1, 2}, {0, 1}, {2, 1}})
    CHECK((*found)[row][column] == 0);
}

TEST_CASE("a flat body is moved with its normal, a line is not moved at all") {
  Model flat = pyramid();
  flat.vertices[3].position = {2, 3, 0};
  compute_smooth_normals(flat);
  const Model copy = moved(flat, kMatrix);
  const auto found = affine_between(flat, copy);
  REQUIRE(found);
  const Model again = moved(flat, *found);
  for (size_t i = 0; i < 4; ++i)
    for (size_t axis = 0; axis < 3; ++axis)
      CHECK(std::fabs(again.vertices[i].position[axis] - copy.vertices[i].position[axis]) < 1e-4f);
  Model line = flat;
  for (Vertex& v : line.vertices) v.position[1] = 0;
  CHECK_FALSE(affine_between(line, moved(line, kMatrix)));
}

TEST_CASE("a copy with a corner off by a thousandth, or with its own normals, is not a copy") {
  Model more = pyramid();  // has a fifth vertex, because four can always be moved onto four others
  add_vertex(more, {1, 1, 1}, {0, 0, 1}, 0);
  Model bent = moved(more, kMatrix);
  REQUIRE(affine_between(more, bent));
  bent.vertices[4].position[0] += 0.01f;
  CHECK_FALSE(affine_between(more, bent));
  Model smooth = moved(more, kMatrix);
  smooth.vertices[1].normal = {0, 0, 1};
  CHECK_FALSE(affine_between(more, smooth));
}

TEST_CASE("copies become instances, in the order of the models, and count as triangles of the world") {
  Model repainted = moved(pyramid(), kMatrix), same_paint = repainted;
  for (Vertex& v : repainted.vertices) v.material = 2;
  for (Vertex& v : same_paint.vertices) v.material = 1;
  Scene scene = scene_of({pyramid(), repainted, make_sphere("ball", {0, 0, 0}, 1, 0), same_paint,
                          make_sphere("ball", {0, 0, 0}, 1, 0)});
  const uint64_t triangles = scene.triangles();
  share_copies(scene);
  REQUIRE(scene.models.size() == 4);  // spheres stay, because their place is not given by a matrix
  REQUIRE(scene.instances.size() == 5);
  const uint32_t wanted[] = {0, 1, 2, 0, 3};
  for (size_t i = 0; i < 5; ++i) CHECK(scene.instances[i].model == wanted[i]);
  CHECK(scene.instances[1].to_world == kIdentity);
  CHECK(scene.triangles() == triangles);
  CHECK(scene.stored_triangles() == triangles - 4);
}

TEST_CASE("a scene without copies stays as it is") {
  Scene scene = scene_of({pyramid()});
  const uint64_t hash = scene.hash();
  share_copies(scene);
  CHECK(scene.instances.empty());
  CHECK(scene.hash() == hash);
}

TEST_CASE("textures count as equal by their texels, not by their number") {
  const auto stored_models = [](uint8_t third_texel) {
    Scene scene = scene_of({pyramid(), moved(pyramid(), kMatrix), moved(pyramid(), kMatrix)});
    const auto texture = [](uint8_t texel) { return Texture{"t", 1, 1, {texel, 0, 0, 255}}; };
    scene.textures = {texture(1), texture(1), texture(third_texel)};
    for (size_t i = 0; i < 3; ++i) {
      scene.materials[i] = scene.materials[0];
      scene.materials[i].texture = int32_t(i);
      for (Vertex& v : scene.models[i].vertices) v.material = int32_t(i);
    }
    share_copies(scene);
    return scene.models.size();
  };
  CHECK(stored_models(1) == 1);
  CHECK(stored_models(2) == 2);
}
