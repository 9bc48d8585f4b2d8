// Builds SHIP, a schooner against the sky, from the original file or generated.
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "scenes/import/obj_loader.h"
#include "scenes/lumibench/builders.h"
#include "scenes/mesh.h"

namespace glint::scenes {

Scene build_ship(const LoadOptions& options, const std::string& original) {
  Scene scene;
  scene.name = "SHIP";
  scene.camera = {.eye = {378, 278, 500}, .target = {178, 278, 0}, .field_of_view = 50};
  Model ship;
  if (original.empty()) {
    ship = make_schooner(scene);
    scene.form = "built-in";
    scene.note =
        "The scene is a procedural schooner with the original's bounds and number of materials, and about "
        "its triangle count (6,255).";
  } else {
    ship = load_obj(original, scene.materials, {.threads = options.threads});
    scene.form = "original";
    scene.note = "The scene is complete: the original mesh is from the assets folder.";
  }
  place(ship, {.translation = {173, -9, -377}, .scale = 100, .rotation_y = 75});
  scene.models.push_back(std::move(ship));
  return scene;
}

}  // namespace glint::scenes
