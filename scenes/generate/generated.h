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

  int32_t material(const Material& material) {
    scene_.materials.push_back(material);
    return int32_t(scene_.materials.size() - 1);
  }
  int32_t color(float r, float g, float b) { return material(lambertian(r, g, b)); }
  // Adds a white material that shows `texture`, and returns its index.
  int32_t textured(Texture texture);

  // Calls make(model) and takes the model into the scene.
  template <class Make>
  void model(std::string name, Make&& make) {
    Model model;
    model.name = std::move(name);
    make(model);
    take(std::move(model));
  }

  // Returns the number of triangles that are still to be made.
  uint64_t rest() const { return made_ < triangles_ ? triangles_ - made_ : 0; }

 private:
  void take(Model model);

  Scene& scene_;
  const LoadOptions& options_;
  uint64_t triangles_, made_ = 0;
};

}  // namespace glint::scenes
