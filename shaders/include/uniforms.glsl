// Declares binding 3: camera, light and counts of one frame, 320 bytes (scenes/camera.h writes them).
// SPDX-License-Identifier: Apache-2.0
#ifndef GLINT_UNIFORMS_GLSL
#define GLINT_UNIFORMS_GLSL

layout(set = 0, binding = 3, std140) uniform FrameUniforms {
  mat4 model_view;
  mat4 projection;
  mat4 model_view_inverse;
  mat4 projection_inverse;
  vec3 light_position;
  float light_radius;
  float aperture;
  float focus_distance;
  float heatmap_scale;
  uint total_samples;
  uint samples;
  uint bounces;
  uint secondary_rays;  // shadow rays or ambient-occlusion rays per hit
  uint random_seed;
  uint width;
  uint height;
  uint has_sky;
  uint show_heatmap;
} frame;

#endif
