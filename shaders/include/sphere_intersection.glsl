// Intersects a ray with a procedural sphere in world space (instances have no transform).
// SPDX-License-Identifier: Apache-2.0
#include "geometry.glsl"

hitAttributeEXT vec4 sphere;

void main() {
  vec4 center_radius = spheres[gl_InstanceCustomIndexEXT];
  vec3 origin = gl_WorldRayOriginEXT;
  vec3 direction = gl_WorldRayDirectionEXT;
  float t_min = gl_RayTminEXT;
  float t_max = gl_RayTmaxEXT;

  // Solves |origin + t direction - centre|^2 = radius^2, with half of the linear coefficient.
  vec3 offset = origin - center_radius.xyz;
  float a = dot(direction, direction);
  float b = dot(offset, direction);
  float c = dot(offset, offset) - center_radius.w * center_radius.w;
  float discriminant = b * b - a * c;
  if (discriminant >= 0.0) {
    float t1 = (-b - sqrt(discriminant)) / a;
    float t2 = (-b + sqrt(discriminant)) / a;
    bool near = t_min <= t1 && t1 < t_max;
    bool far = t_min <= t2 && t2 < t_max;
    if (near || far) {
      sphere = center_radius;
      reportIntersectionEXT(near ? t1 : t2, 0u);
    }
  }
}
