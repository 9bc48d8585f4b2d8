// Computes how each material model answers a ray: a colour, a next direction, and whether the path goes on.
// SPDX-License-Identifier: Apache-2.0
#ifndef GLINT_SCATTER_GLSL
#define GLINT_SCATTER_GLSL
#include "geometry.glsl"
#include "payload.glsl"
#include "random.glsl"

vec4 sample_texture(Material material, vec2 coordinate) {
  if (material.texture_index < 0) return vec4(1.0);
  return textureLod(textures[nonuniformEXT(material.texture_index)], coordinate, 0.0);
}

// Uses Schlick 1994. `cosine` may exceed 1 when the ray leaves the body. The result is then NaN, no random number
// is below it, and the ray is refracted, as in the original.
float reflect_probability(float cosine, float refraction_index) {
  float r0 = (1.0 - refraction_index) / (1.0 + refraction_index);
  r0 = r0 * r0;
  return r0 + (1.0 - r0) * pow(1.0 - cosine, 5.0);
}

void scatter_lambertian(inout RayPayload ray, Material material, vec3 color, vec3 direction, vec3 normal) {
  ray.color_and_distance.rgb = material.diffuse.rgb * color;
  ray.scatter.xyz = normal + random_in_unit_sphere(ray.random_state);
  ray.scatter.w = dot(direction, normal) < 0.0 ? 1.0 : 0.0;
}

void scatter_metallic(inout RayPayload ray, Material material, vec3 color, vec3 direction, vec3 normal) {
  vec3 reflected = reflect(direction, normal);
  ray.color_and_distance.rgb = material.diffuse.rgb * color;
  ray.scatter.xyz = reflected + material.fuzziness * random_in_unit_sphere(ray.random_state);
  ray.scatter.w = dot(reflected, normal) > 0.0 ? 1.0 : 0.0;
}

void scatter_dielectric(inout RayPayload ray, Material material, vec3 color, vec3 direction, vec3 normal) {
  float index = material.refraction_index;
  float projection = dot(direction, normal);
  bool leaves = projection > 0.0;
  vec3 outward = leaves ? -normal : normal;
  float ratio = leaves ? index : 1.0 / index;
  float cosine = leaves ? index * projection : -projection;
  vec3 refracted = refract(direction, outward, ratio);
  float probability = 1.0;
  if (refracted != vec3(0.0)) probability = reflect_probability(cosine, index);
  ray.color_and_distance.rgb = color;
  if (random_float(ray.random_state) < probability)
    ray.scatter.xyz = reflect(direction, normal);
  else
    ray.scatter.xyz = refracted;
  ray.scatter.w = 1.0;
}

// Fills colour, distance, scatter and random state of the payload.
void scatter_ray(inout RayPayload ray, int material_index, vec2 coordinate, vec3 ray_direction, vec3 normal,
                 float distance) {
  Material material = materials[material_index];
  vec3 direction = normalize(ray_direction);
  ray.color_and_distance.w = distance;
  if (material.model == kDiffuseLight) {
    ray.color_and_distance.rgb = material.diffuse.rgb;
    ray.scatter = vec4(1.0, 0.0, 0.0, 0.0);
    return;
  }
  vec3 color = sample_texture(material, coordinate).rgb;
  if (material.model == kLambertian)
    scatter_lambertian(ray, material, color, direction, normal);
  else if (material.model == kMetallic)
    scatter_metallic(ray, material, color, direction, normal);
  else
    scatter_dielectric(ray, material, color, direction, normal);
}

#endif
