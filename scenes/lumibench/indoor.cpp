// Builds BUNNY and REF, the Cornell box with a large mesh in it: plain, or with mirror walls and a glass
// sphere.
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "scenes/import/obj_loader.h"
#include "scenes/lumibench/builders.h"
#include "scenes/mesh.h"

namespace glint::scenes {
namespace {

constexpr const char* kStanfordBunny = "BUNNY/stanford-bunny.obj";  // a stand-in of another scale and size
constexpr const char* kSmallLucy = "REF/lucy.obj";                  // a decimated statue of another scale

Camera indoor_camera(float eye_z, float field_of_view, float light_z) {
  return {.eye = {278, 278, eye_z},
          .target = {278, 278, 0},
          .field_of_view = field_of_view,
          .has_sky = false,
          .light_position = {280, 500, light_z},
          .light_radius = 10};
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// Scales a model about the origin, then moves it.
void adjust(Model& model, float scale, const Vec3& move) {
  for (Vertex& vertex : model.vertices) vertex.position = vertex.position * scale + move;
}

Model load_bunny(Scene& scene, const std::string& path, uint32_t threads) {
  scene.form = "stand-in";
  if (path.empty()) {
    scene.form = "built-in";
    scene.note =
        "The mesh is a procedural bunny with the original's size and place and about its triangle count "
        "(144,046).";
    return make_bunny_stand_in(add_material(scene, "bunny", lambertian(0.7f, 0.7f, 0.7f)), threads);
  }
  Model model = load_obj(path, scene.materials, {.threads = threads});
  if (ends_with(path, kStanfordBunny)) {
    adjust(model, 10, {0, -0.33f, 0});  // to the original's units, with its feet on the floor
    scene.note = "The Stanford bunny (69,451 triangles) replaces the original's 144,046-triangle mesh.";
  } else {
    scene.form = "original";
    scene.note = "Mesh from the assets folder.";
  }
  return model;
}

Model load_statue(Scene& scene, const std::string& path, uint32_t threads) {
  scene.form = "stand-in";
  if (path.empty()) {
    scene.form = "built-in";
    scene.note =
        "The mesh is a procedural winged statue with the original's size and place and about its triangle "
        "count (448.9K).";
    return make_statue_stand_in(add_material(scene, "statue", lambertian(0.7f, 0.7f, 0.7f)), threads);
  }
  Model model = load_obj(path, scene.materials, {.threads = threads});
  if (ends_with(path, kSmallLucy)) {
    constexpr float kScale = 0.37f;  // about 355 world units of height after the placement
    const Bounds box = bounds(model);
    adjust(model, kScale,
           {-kScale * 0.5f * (box.lower[0] + box.upper[0]), 15 - kScale * box.lower[1],
            -kScale * 0.5f * (box.lower[2] + box.upper[2])});
    scene.note = "A decimated statue (99,970 triangles) replaces the original's 448.9K-triangle mesh.";
  } else {
    scene.form = "original";
    scene.note = "Mesh from the assets folder.";
  }
  return model;
}

}  // namespace

Scene build_bunny(const LoadOptions& options, const std::string& original) {
  Scene scene;
  scene.name = "BUNNY";
  add_cornell_materials(scene);
  scene.camera = indoor_camera(800, 40, 400);
  scene.models.push_back(make_cornell_box());
  Model bunny = load_bunny(scene, original, options.threads);
  place(bunny, {.translation = {173, 5, -307}, .scale = 200, .rotation_y = 75});
  scene.models.push_back(std::move(bunny));
  return scene;
}

Scene build_mirror_box(const LoadOptions& options, const std::string& original) {
  Scene scene;
  scene.name = "REF";
  add_cornell_materials(scene);
  scene.materials[0] = metallic(0.65f, 0.05f, 0.05f, 0);
  scene.materials[1] = metallic(0.12f, 0.45f, 0.15f, 0);
  add_material(scene, "glass", dielectric(1.5f));
  scene.camera = indoor_camera(350, 78, 280);
  scene.models.push_back(make_cornell_box());
  scene.models.push_back(make_sphere("glass_sphere", {425, 165, -147.5f}, 80, 4));
  Model statue = load_statue(scene, original, options.threads);
  place(statue, {.translation = {173, -9, -377}, .scale = 0.6f, .rotation_y = 75});
  scene.models.push_back(std::move(statue));
  return scene;
}

}  // namespace glint::scenes
