// Fills a frame's uniform block (binding 3): camera matrices, light and counts, as the shaders read them.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/camera.h"

#include <cmath>
#include <cstring>
#include <numbers>

#include "scenes/mesh.h"

namespace glint::scenes {
namespace {

constexpr double kNear = 0.1, kFar = 10000;  // planes of LumiBench's application
constexpr float kHeatmapScale = 1.5f;        // the application's default; no shader of the workloads reads it
constexpr uint32_t kDefaultSecondaryRays = 16;  // the application's default number of shadow rays

}  // namespace

CameraMatrices camera_matrices(const Camera& camera, float aspect) {
  CameraMatrices m{Mat4(0), Mat4(0), Mat4(0), Mat4(0)};
  // These are the camera's axes in the world: right, up, and backwards, because it looks along -z.
  const Vec3 forward = normalized(camera.target - camera.eye);
  const Vec3 right = normalized(cross(forward, camera.up));
  const Vec3 up = cross(right, forward);
  const Vec3 back = forward * -1.0f;
  const Vec3 axes[3] = {right, up, back};
  for (size_t axis = 0; axis < 3; ++axis) {
    m.model_view[axis] = {right[axis], up[axis], back[axis], 0};
    m.model_view_inverse[axis] = Vec4(axes[axis], 0);
  }
  m.model_view[3] = {-dot(right, camera.eye), -dot(up, camera.eye), -dot(back, camera.eye), 1};
  m.model_view_inverse[3] = Vec4(camera.eye, 1);

  // The inverses are written down and not computed, because the view is rigid and the projection has five
  // entries.
  const double tangent = std::tan(double(camera.field_of_view) * std::numbers::pi / 360);
  const double depth = kFar / (kNear - kFar), shift = kNear * kFar / (kNear - kFar);
  m.projection[0][0] = float(1 / (double(aspect) * tangent));
  m.projection[1][1] = float(-1 / tangent);
  m.projection[2][2] = float(depth);
  m.projection[2][3] = -1;
  m.projection[3][2] = float(shift);
  m.projection_inverse[0][0] = float(double(aspect) * tangent);
  m.projection_inverse[1][1] = float(-tangent);
  m.projection_inverse[2][3] = float(1 / shift);
  m.projection_inverse[3][2] = -1;
  m.projection_inverse[3][3] = float(depth / shift);
  return m;
}

FrameUniforms frame_uniforms(const Scene& scene, Workload workload, const RenderParams& params) {
  FrameUniforms u{};
  const Camera& camera = scene.camera;
  u.matrices = camera_matrices(camera, float(params.whole_width()) / float(params.whole_height()));
  u.light_position = camera.light_position;
  u.light_radius = camera.light_radius;
  u.aperture = camera.aperture;
  u.focus_distance = camera.focus_distance;
  u.heatmap_scale = kHeatmapScale;
  u.total_samples = u.samples = params.samples;  // The first frame reads no earlier sum.
  u.bounces = params.bounces;
  switch (workload) {
    case Workload::PathTracing:
      u.secondary_rays = kDefaultSecondaryRays;
      break;
    case Workload::Shadow:
      u.secondary_rays = params.shadow_rays;
      break;
    case Workload::AmbientOcclusion:
      u.secondary_rays = params.ao_rays;
      break;
  }
  u.random_seed = params.seed;
  u.width = params.whole_width();
  u.height = params.whole_height();
  u.has_sky = camera.has_sky;
  return u;
}

std::vector<std::byte> uniform_block(const Scene& scene, Workload workload, const RenderParams& params) {
  const FrameUniforms uniforms = frame_uniforms(scene, workload, params);
  std::vector<std::byte> bytes(sizeof uniforms);
  std::memcpy(bytes.data(), &uniforms, sizeof uniforms);
  return bytes;
}

}  // namespace glint::scenes
