// Each hit record says which callable shader paints it, and in which colour.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require
layout(shaderRecordEXT, std430) buffer Record {
  vec3 tint;
  uint painter;
} record;
struct Paint {
  vec2 at;
  float shade;
};
layout(location = 0) callableDataEXT Paint paint;
layout(location = 0) rayPayloadInEXT vec3 color;

void main() {
  paint.at = (gl_WorldRayOriginEXT + gl_HitTEXT * gl_WorldRayDirectionEXT).xy;
  executeCallableEXT(record.painter, 0);
  color = record.tint * paint.shade;
}
