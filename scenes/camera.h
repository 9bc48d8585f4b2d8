// What a frame's uniform block (binding 3) holds: camera matrices, light and counts, as the shaders read
// them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scenes/render_params.h"
#include "scenes/scene.h"

namespace glint::scenes {

enum class Workload { PathTracing, Shadow, AmbientOcclusion };

// Column-major: column c, row r at [4 * c + r], as std140 lays out a mat4.
using Mat4 = std::array<float, 16>;

struct CameraMatrices {
  Mat4 model_view, projection, model_view_inverse, projection_inverse;
};

// Right-handed look-at view, perspective with depth 0..1, near 0.1, far 10000, and y pointing down as Vulkan
// has it. `aspect` is width over height.
CameraMatrices camera_matrices(const Camera& camera, float aspect);

// Binding 3, std140.
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

// `secondary_rays` is the workload's own count; path tracing, which casts none, has the application's
// default, 16.
FrameUniforms frame_uniforms(const Scene& scene, Workload workload, const RenderParams& params);

// The same as 320 bytes.
std::vector<std::byte> uniform_block(const Scene& scene, Workload workload, const RenderParams& params);

}  // namespace glint::scenes
