// Makes materials of each model as plain records. What a model does not use is zero.
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "scenes/lumibench/builders.h"

namespace glint::scenes {

Material lambertian(float r, float g, float b) {
  return {.diffuse = {r, g, b, 1}, .model = MaterialModel::Lambertian};
}

Material metallic(float r, float g, float b, float fuzziness) {
  return {.diffuse = {r, g, b, 1}, .fuzziness = fuzziness, .model = MaterialModel::Metallic};
}

Material dielectric(float refraction_index) {
  // The application stores this colour and never uses it.
  return {.diffuse = {0.7f, 0.7f, 1, 1},
          .refraction_index = refraction_index,
          .model = MaterialModel::Dielectric};
}

Material diffuse_light(float r, float g, float b) {
  return {.diffuse = {r, g, b, 1}, .model = MaterialModel::DiffuseLight};
}

int32_t add_material(Scene& scene, std::string name, const Material& material) {
  scene.materials.push_back(material);
  scene.material_names.resize(scene.materials.size());
  scene.material_names.back() = std::move(name);
  return int32_t(scene.materials.size() - 1);
}

}  // namespace glint::scenes
