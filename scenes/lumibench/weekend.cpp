// Builds WKND, the 487 spheres of "Ray Tracing in One Weekend", drawn in the application's order.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <random>
#include <utility>

#include "scenes/generate/uniform_float.h"
#include "scenes/lumibench/builders.h"
#include "scenes/mesh.h"

namespace glint::scenes {
namespace {

constexpr uint32_t kSeed = 42;  // seed of the application's std::mt19937

struct Spheres {
  Scene scene;
  std::mt19937 engine{kSeed};

  float draw() { return uniform_float(engine); }
  // A sphere without a name has its number as the name of both.
  void add(const Vec3& center, float radius, const Material& material, std::string name = "") {
    const int32_t index = add_material(scene, std::move(name), material);
    scene.models.push_back(make_sphere(fmt::format("sphere_{}", index), center, radius, index));
  }
};

// Draws the material of a small sphere. Colours are drawn blue first, which is the order in which the
// application's compiler evaluated the constructor's arguments.
Material draw_material(Spheres& spheres, float choice) {
  if (choice < 0.8f) {
    float color[3];
    for (int k = 2; k >= 0; --k) {
      const float first = spheres.draw();
      color[k] = first * spheres.draw();
    }
    return lambertian(color[0], color[1], color[2]);
  }
  if (choice < 0.95f) {
    const float fuzziness = 0.5f * spheres.draw();
    float color[3];
    for (int k = 2; k >= 0; --k) color[k] = 0.5f * (1 + spheres.draw());
    return metallic(color[0], color[1], color[2], fuzziness);
  }
  return dielectric(1.5f);
}

}  // namespace

Scene build_weekend(const LoadOptions&, const std::string&) {
  Spheres spheres;
  spheres.add({0, -1000, 0}, 1000, lambertian(0.5f, 0.5f, 0.5f), "ground");
  for (int i = -11; i < 11; ++i)
    for (int j = -11; j < 11; ++j) {
      const float choice = spheres.draw();
      const float z = float(j) + 0.9f * spheres.draw();
      const float x = float(i) + 0.9f * spheres.draw();
      const Vec3 center{x, 0.2f, z};
      if (length(center - Vec3{4, 0.2f, 0}) > 0.9f) spheres.add(center, 0.2f, draw_material(spheres, choice));
    }
  spheres.add({0, 1, 0}, 1, dielectric(1.5f), "large_glass");
  spheres.add({-4, 1, 0}, 1, lambertian(0.4f, 0.2f, 0.1f), "large_matte");
  spheres.add({4, 1, 0}, 1, metallic(0.7f, 0.6f, 0.5f, 0), "large_mirror");

  Scene& scene = spheres.scene;
  scene.name = "WKND";
  scene.form = "original";
  scene.note = "The scene is complete: all 487 spheres are generated as in the original application.";
  scene.camera = {
      .eye = {13, 2, 3}, .target = {0, 0, 0}, .field_of_view = 20, .aperture = 0.1f, .focus_distance = 10};
  return std::move(scene);
}

}  // namespace glint::scenes
