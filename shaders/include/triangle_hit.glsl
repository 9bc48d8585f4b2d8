// Handles the closest hit on a triangle. GLINT_KEEP_HIT_POINT: also store the hit point and the normal towards the ray.
// SPDX-License-Identifier: Apache-2.0
#include "scatter.glsl"

layout(location = 0) rayPayloadInEXT RayPayload ray;
hitAttributeEXT vec2 barycentrics;

void main() {
  Surface surface = load_surface(gl_InstanceCustomIndexEXT, gl_PrimitiveID, barycentrics);
  vec3 normal = surface.normal;
#ifdef GLINT_KEEP_HIT_POINT
  if (dot(gl_WorldRayDirectionEXT, normal) > 0.0) normal = -normal;
#endif
  scatter_ray(ray, surface.material, surface.texture_coordinate, gl_WorldRayDirectionEXT, normal, gl_HitTEXT);
#ifdef GLINT_KEEP_HIT_POINT
  ray.scatter.xyz = gl_WorldRayOriginEXT + gl_HitTEXT * gl_WorldRayDirectionEXT;
  ray.normal = normal;
#endif
}
