// Names GLM's vectors for the reference, and adds what GLM rounds otherwise than GLSL's definition.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace glint::reference {

using Vec = glm::vec3;
using glm::dot;
using glm::length;
using glm::mix;
using glm::reflect;
using glm::refract;

// Divides by the length. glm::normalize() multiplies by the reciprocal of the length, which rounds twice.
inline Vec normalize(const Vec& v) {
  return v / length(v);
}

}  // namespace glint::reference
