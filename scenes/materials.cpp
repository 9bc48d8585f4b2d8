// Makes materials of each model as plain records. What a model does not use is zero.
// SPDX-License-Identifier: Apache-2.0
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

}  // namespace glint::scenes
