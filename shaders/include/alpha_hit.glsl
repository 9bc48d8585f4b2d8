// Lets a ray pass through texels whose alpha is exactly zero, in any-hit shaders.
// SPDX-License-Identifier: Apache-2.0
#include "geometry.glsl"

hitAttributeEXT vec2 barycentrics;

void main() {
  Surface surface = load_surface(gl_InstanceCustomIndexEXT, gl_PrimitiveID, barycentrics);
  Material material = materials[surface.material];
  float alpha = 1.0;
  if (material.texture_index >= 0)
    alpha = textureLod(textures[nonuniformEXT(material.texture_index)], surface.texture_coordinate, 0.0).a;
  if (alpha == 0.0) ignoreIntersectionEXT;
}
