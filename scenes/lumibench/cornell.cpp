// Builds the Cornell box of LumiBench's indoor scenes, and CORNELL: the box alone, Glint's own test scene.
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "scenes/lumibench/builders.h"
#include "scenes/mesh.h"

namespace glint::scenes {
namespace {

constexpr float kEdge = 555;                    // world units, as in "Ray Tracing: The Next Week"
constexpr float kLightHeight = 0.998f * kEdge;  // 553.89: just under the ceiling
constexpr int32_t kRed = 0, kGreen = 1, kWhite = 2, kLight = 3;

// Adds two triangles over four corners, which go clockwise as seen from inside. The normal points into the
// box, and the triangles are counter-clockwise.
void add_wall(Model& box, const std::array<Vec3, 4>& corners, const Vec3& normal, int32_t material) {
  constexpr Vec2 kCoordinates[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const uint32_t first = uint32_t(box.vertices.size());
  for (size_t k = 0; k < 4; ++k) add_vertex(box, corners[k], normal, material, kCoordinates[k]);
  add_triangle(box, first, first + 2, first + 1);
  add_triangle(box, first, first + 3, first + 2);
}

}  // namespace

Model make_cornell_box() {
  constexpr float e = kEdge, h = kLightHeight;
  Model box;
  box.name = "cornell_box";
  add_wall(box, {{{0, 0, -e}, {0, 0, 0}, {0, e, 0}, {0, e, -e}}}, {1, 0, 0}, kGreen);
  add_wall(box, {{{e, 0, 0}, {e, 0, -e}, {e, e, -e}, {e, e, 0}}}, {-1, 0, 0}, kRed);
  add_wall(box, {{{0, 0, -e}, {e, 0, -e}, {e, 0, 0}, {0, 0, 0}}}, {0, 1, 0}, kWhite);
  add_wall(box, {{{0, e, 0}, {e, e, 0}, {e, e, -e}, {0, e, -e}}}, {0, -1, 0}, kWhite);
  add_wall(box, {{{e, 0, -e}, {0, 0, -e}, {0, e, -e}, {e, e, -e}}}, {0, 0, 1}, kWhite);
  add_wall(box, {{{213, h, -223}, {343, h, -223}, {343, h, -328}, {213, h, -328}}}, {0, -1, 0}, kLight);
  return box;
}

void add_cornell_materials(Scene& scene) {
  add_material(scene, "right_wall", lambertian(0.65f, 0.05f, 0.05f));
  add_material(scene, "left_wall", lambertian(0.12f, 0.45f, 0.15f));
  add_material(scene, "white", lambertian(0.73f, 0.73f, 0.73f));
  add_material(scene, "light", diffuse_light(15, 15, 15));
}

Scene build_cornell(const LoadOptions&, const std::string&) {
  Scene scene;
  scene.name = "CORNELL";
  scene.form = "built-in";
  scene.note = "The scene is the Cornell box alone, Glint's own small scene; LumiBench has no such scene.";
  scene.models.push_back(make_cornell_box());
  add_cornell_materials(scene);
  scene.camera = {.eye = {278, 278, 800},
                  .target = {278, 278, 0},
                  .field_of_view = 40,
                  .has_sky = false,
                  .light_position = {280, 500, 400},
                  .light_radius = 10};
  return scene;
}

}  // namespace glint::scenes
