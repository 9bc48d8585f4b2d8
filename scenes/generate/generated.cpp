// Adds models and materials to generated scenes one after the other, with progress and the budget of
// triangles.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/generated.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace glint::scenes {

int32_t Generator::textured(std::string name, Texture texture) {
  scene_.textures.push_back(std::move(texture));
  const int32_t index = material(std::move(name), lambertian(1, 1, 1));
  scene_.materials.back().texture = int32_t(scene_.textures.size() - 1);
  return index;
}

void Generator::take(Model model) {
  model.vertices.shrink_to_fit();
  model.indices.shrink_to_fit();
  if (!model.is_procedural()) made_ += model.indices.size() / 3;
  scene_.models.push_back(std::move(model));
  if (options_.progress) options_.progress(std::min(1.0, double(made_) / double(triangles_)));
}

}  // namespace glint::scenes
