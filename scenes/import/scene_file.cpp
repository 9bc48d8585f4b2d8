// Chooses the loader of a file, and the camera of files that have none.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/scene_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>

#include "base/diagnostics.h"
#include "base/lookup.h"
#include "scenes/import/asset_folder.h"
#include "scenes/import/obj_loader.h"
#include "scenes/mesh.h"

namespace glint::scenes {
namespace {

namespace fs = std::filesystem;

constexpr float kFieldOfView = 40;           // degrees, for files without a camera
constexpr Vec3 kFromThere{0.55f, 0.35f, 1};  // the camera looks from the right and a little above

constexpr float kMost = std::numeric_limits<float>::max();
constexpr Bounds kNothing{{kMost, kMost, kMost}, {-kMost, -kMost, -kMost}};

std::string ending_of(const std::string& name) {
  std::string ending = fs::path(name).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return ending;
}

// Returns a camera that sees the whole box, wherever it lies.
Camera camera_around(const Bounds& box) {
  const Vec3 centre = (box.lower + box.upper) * 0.5f;
  const float radius = std::max(length(box.upper - box.lower) * 0.5f, 1e-6f);
  Camera camera;
  camera.field_of_view = kFieldOfView;
  camera.target = centre;
  camera.eye = centre + normalized(kFromThere) * (radius / sine(double(kFieldOfView) / 360 * M_PI));
  return camera;
}

Scene load_obj_scene(const std::string& path, const LoadOptions& options) {
  Scene scene;
  scene.models.push_back(load_obj(path, scene.materials,
                                  {.textures = &scene.textures,
                                   .names = &scene.material_names,
                                   .threads = options.threads,
                                   .log = options.log}));
  if (scene.models[0].indices.empty()) throw UserError({path}, "this file has no triangles");
  scene.models[0].name = fs::path(path).stem().string();
  return scene;
}

}  // namespace

bool names_scene_file(const std::string& name) {
  const std::string ending = ending_of(name);
  return ending == ".obj" || ending == ".gltf" || ending == ".glb";
}

Model flattened(const Scene& scene) {
  Model out;
  for (const Instance& instance : instances_of(scene))
    if (const Model& model = scene.models[instance.model]; !model.is_procedural())
      append_copy(out, model, instance.to_world, -1);
  return out;
}

Bounds moved(const Bounds& box, const Affine& m) {
  Bounds out = kNothing;
  for (size_t corner = 0; corner < 8; ++corner)
    for (size_t r = 0; r < 3; ++r) {
      float x = m[r][3];
      for (size_t k = 0; k < 3; ++k) x += m[r][k] * (corner >> k & 1 ? box.upper[k] : box.lower[k]);
      out.lower[r] = std::min(out.lower[r], x);
      out.upper[r] = std::max(out.upper[r], x);
    }
  return out;
}

Bounds world_bounds(const Scene& scene) {
  Bounds out = kNothing;
  for (const Instance& instance : instances_of(scene)) {
    const Model& model = scene.models[instance.model];
    if (model.vertices.empty()) continue;
    // A sphere's vertices are those of its tessellation.
    const Bounds box = moved(bounds(model), instance.to_world);
    for (size_t r = 0; r < 3; ++r) {
      out.lower[r] = std::min(out.lower[r], box.lower[r]);
      out.upper[r] = std::max(out.upper[r], box.upper[r]);
    }
  }
  return out;
}

Scene load_scene_file(const std::string& path, const LoadOptions& options) {
  std::error_code failed;
  if (!fs::is_regular_file(path, failed)) throw UserError({path}, "there is no such file");
  if (options.log) options.log->add(path);
  Scene scene = ending_of(path) == ".obj" ? load_obj_scene(path, options) : load_gltf(path, options);
  scene.name = fs::path(path).stem().string();
  scene.form = "file";
  if (scene.camera.eye == scene.camera.target) {
    const bool has_sky = scene.camera.has_sky;
    const Vec3 light = scene.camera.light_position;
    const float radius = scene.camera.light_radius;
    scene.camera = camera_around(world_bounds(scene));
    scene.camera.has_sky = has_sky, scene.camera.light_position = light, scene.camera.light_radius = radius;
    scene.note += " The file has no camera, so the camera was placed where it sees the whole scene.";
  }
  return scene;
}

}  // namespace glint::scenes
