// Builds generated scenes. Models and materials are added one after the other, with progress and the budget
// of triangles.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <utility>

#include "scenes/lumibench/builders.h"

namespace glint::scenes {

class Generator {
 public:
  // `triangles` is the number of triangles of the whole scene.
  Generator(Scene& scene, const LoadOptions& options, uint64_t triangles)
      : scene_(scene), options_(options), triangles_(triangles) {
    scene.form = "built-in";
  }

  // Add a material and return its index. Materials without a name get the one of their models.
  int32_t material(std::string name, const Material& material) {
    return add_material(scene_, std::move(name), material);
  }
  int32_t color(std::string name, float r, float g, float b) {
    return material(std::move(name), lambertian(r, g, b));
  }
  int32_t textured(std::string name, Texture texture);  // white, with the texture

  // Calls make(model) and takes the model into the scene.
  template <class Make>
  void model(std::string name, Make&& make) {
    Model model;
    model.name = std::move(name);
    make(model);
    take(std::move(model));
  }

  uint32_t threads() const { return options_.threads; }  // threads of the host that may make a model
  // Returns the number of triangles that are still to be made.
  uint64_t rest() const { return made_ < triangles_ ? triangles_ - made_ : 0; }

 private:
  void take(Model model);

  Scene& scene_;
  const LoadOptions& options_;
  uint64_t triangles_, made_ = 0;
};

}  // namespace glint::scenes
