// Handles the closest hit on a procedural sphere. In every workload the scatter direction stays a direction.
// SPDX-License-Identifier: Apache-2.0
#include "scatter.glsl"

layout(location = 0) rayPayloadInEXT RayPayload ray;
hitAttributeEXT vec4 sphere;

const float kPi = 3.1415926535897932;

void main() {
  uvec2 offsets = model_offsets[gl_InstanceCustomIndexEXT];
  Vertex first = load_vertex(offsets.y + indices[offsets.x]);
  vec4 center_radius = spheres[gl_InstanceCustomIndexEXT];
  vec3 point = gl_WorldRayOriginEXT + gl_HitTEXT * gl_WorldRayDirectionEXT;
  vec3 normal = (point - center_radius.xyz) / center_radius.w;
  vec2 coordinate = vec2((atan(normal.x, normal.z) + kPi) / (2.0 * kPi), 1.0 - (asin(normal.y) + kPi / 2.0) / kPi);
  scatter_ray(ray, first.material, coordinate, gl_WorldRayDirectionEXT, normal, gl_HitTEXT);
  ray.normal = normal;
}
