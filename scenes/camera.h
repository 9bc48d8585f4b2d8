// Declares a frame's uniform block (binding 3): camera matrices, light and counts, as the shaders read them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <vector>

#include "scenes/render_params.h"
#include "scenes/scene.h"

namespace glint::scenes {

enum class Workload { PathTracing, Shadow, AmbientOcclusion };

// Holds a matrix in column-major order, as std140 lays out a mat4: column c, row r is at [c][r].
using Mat4 = glm::mat4;

struct CameraMatrices {
  Mat4 model_view, projection, model_view_inverse, projection_inverse;
};

// Returns a right-handed look-at view and a perspective with depth 0 to 1, near plane 0.1 and far plane
// 10000, in which y points down as in Vulkan. `aspect` is width over height.
CameraMatrices camera_matrices(const Camera& camera, float aspect);

// Has the layout of binding 3 in std140.
struct FrameUniforms {
  CameraMatrices matrices;
  Vec3 light_position;
  float light_radius, aperture, focus_distance, heatmap_scale;
  uint32_t total_samples, samples, bounces, secondary_rays, random_seed;
  uint32_t width, height, has_sky, show_heatmap;
};
static_assert(sizeof(FrameUniforms) == 320);
static_assert(offsetof(FrameUniforms, light_position) == 256 &&
              offsetof(FrameUniforms, total_samples) == 284 && offsetof(FrameUniforms, width) == 304);

// Returns the uniforms of one frame. `secondary_rays` is the workload's own count. Path tracing casts none
// and gets the application's default, 16.
FrameUniforms frame_uniforms(const Scene& scene, Workload workload, const RenderParams& params);

// Returns the same uniforms as 320 bytes.
std::vector<std::byte> uniform_block(const Scene& scene, Workload workload, const RenderParams& params);

}  // namespace glint::scenes
