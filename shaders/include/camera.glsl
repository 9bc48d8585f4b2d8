// Holds the part that all ray-generation shaders share: scene, images, a camera ray per sample, and the end of a pixel.
// SPDX-License-Identifier: Apache-2.0
#ifndef GLINT_CAMERA_GLSL
#define GLINT_CAMERA_GLSL
#include "payload.glsl"
#include "random.glsl"
#include "uniforms.glsl"

layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1, rgba32f) uniform image2D accumulation;
layout(set = 0, binding = 2, rgba32f) uniform image2D picture;
layout(location = 0) rayPayloadEXT RayPayload ray;

const float kRayMin = 0.001;    // in lengths of the direction
const float kRayMax = 10000.0;

uint pixel_random_state() {
  return hash_pair(hash_pair(gl_LaunchIDEXT.x, gl_LaunchIDEXT.y), frame.total_samples);
}

// Draws the jitter from a state of its own, which is equal in every pixel, and the lens point from the ray's state.
void make_camera_ray(inout uint jitter_state, inout uint random_state, out vec3 origin, out vec3 direction) {
  vec2 pixel = vec2(gl_LaunchIDEXT.xy);
  float jitter_x = random_float(jitter_state);
  float jitter_y = random_float(jitter_state);
  pixel = pixel + vec2(jitter_x, jitter_y);
  vec2 device = pixel / vec2(gl_LaunchSizeEXT.xy) * 2.0 - 1.0;
  vec2 lens = frame.aperture / 2.0 * random_in_unit_disk(random_state);
  vec4 eye = frame.model_view_inverse * vec4(lens, 0.0, 1.0);
  vec4 target = frame.projection_inverse * vec4(device, 1.0, 1.0);  // not divided by w
  vec4 view = frame.model_view_inverse * vec4(normalize(target.xyz * frame.focus_distance - vec3(lens, 0.0)), 0.0);
  origin = eye.xyz;
  direction = view.xyz;
}

// Adds the sum of earlier frames, stores the new sum, and writes the mean with gamma 2.
void finish_pixel(vec3 sum) {
  ivec2 position = ivec2(gl_LaunchIDEXT.xy);
  if (frame.samples != frame.total_samples) sum = imageLoad(accumulation, position).rgb + sum;
  vec3 mean = sum / float(frame.total_samples);
  imageStore(accumulation, position, vec4(sum, 0.0));
  imageStore(picture, position, vec4(sqrt(mean), 0.0));
}

#endif
