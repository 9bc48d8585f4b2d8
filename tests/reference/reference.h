// Renders the three workloads in plain C++, with code that shares nothing with the machine.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "scenes/camera.h"
#include "scenes/scene.h"
#include "tests/reference/intersector.h"

namespace glint::reference {

struct ReferenceResult {
  uint32_t width = 0, height = 0;
  std::vector<Vec> sum;      // over the samples; row 0 is the top of the picture, as stored to image 1
  std::vector<Vec> mean;     // sum / samples
  std::vector<Vec> picture;  // square root of the mean, as stored to image 2
  std::vector<uint32_t> rays_of_pixel;
  uint64_t rays = 0;  // rays traced over all pixels
};

// Renders in float, in the order in which the shaders compute. The scene must have no instances (surface.h:
// flattened). Rays that may end at their first hit get the closest one. In ambient occlusion the next ray
// depends on the blocker's normal, so a machine may differ in single pixels.
ReferenceResult render(const scenes::Scene& scene, scenes::Workload workload,
                       const scenes::RenderParams& params, Intersector& intersector);

// These are the shaders' random numbers.
uint32_t hash_pair(uint32_t first, uint32_t second);
float random_float(uint32_t& state);

}  // namespace glint::reference
