// Handles a miss: a sky that fades from white to blue, or black indoors. The other fields of the payload stay.
// SPDX-License-Identifier: Apache-2.0
#include "payload.glsl"
#include "uniforms.glsl"

layout(location = 0) rayPayloadInEXT RayPayload ray;

void main() {
  vec3 color = vec3(0.0);
  if (frame.has_sky != 0u) {
    float height = 0.5 * (normalize(gl_WorldRayDirectionEXT).y + 1.0);
    color = mix(vec3(1.0), vec3(0.5, 0.7, 1.0), height);
  }
  ray.color_and_distance = vec4(color, -1.0);
}
