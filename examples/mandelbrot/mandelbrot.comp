// Draws the Mandelbrot set with a thread per pixel. Warps diverge where neighbours leave the loop at different times.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform writeonly image2D picture;
layout(push_constant) uniform View {
  vec2 centre;
  float width;
} view;
layout(constant_id = 0) const uint MOST = 64;

void main() {
  const vec2 size = vec2(gl_NumWorkGroups.xy * gl_WorkGroupSize.xy);
  const vec2 c = view.centre + (vec2(gl_GlobalInvocationID.xy) + 0.5 - 0.5 * size) * view.width / size.x;
  vec2 z = vec2(0.0);
  uint steps = 0;
  while (steps < MOST && dot(z, z) < 16.0) {
    z = vec2(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) + c;
    ++steps;
  }
  const float t = steps == MOST ? 0.0 : float(steps) / float(MOST);
  imageStore(picture, ivec2(gl_GlobalInvocationID.xy), vec4(sqrt(t), t, t * t, 1.0));
}
