// Collects the built-ins of a hit.
// SPDX-License-Identifier: Apache-2.0
#version 460
#include "common.glsl"
#include "parts/info.glsl"
layout(location = 0) rayPayloadInEXT Info info;
hitAttributeEXT vec2 where;
void main() {
  Info mine = info;
  mine.ids.id = uvec4(gl_InstanceID, gl_InstanceCustomIndexEXT, gl_GeometryIndexEXT, gl_PrimitiveID);
  mine.ids.kind = gl_HitKindEXT;
  mine.ids.front[0] = gl_HitKindEXT == gl_HitKindFrontFacingTriangleEXT;
  mine.ids.front[1] = gl_HitKindEXT == gl_HitKindBackFacingTriangleEXT;
  mine.bary[0] = where.x;
  mine.bary[1] = where.y;
  mine.to_world = gl_ObjectToWorldEXT;
  mine.to_object = mat3(gl_WorldToObjectEXT);
  mine.object_origin = gl_WorldToObjectEXT * vec4(gl_WorldRayOriginEXT, 1.0);
  if (mine.object_origin != gl_ObjectRayOriginEXT) mine.object_origin = vec3(-77.0);
  mine.object_direction = gl_ObjectRayDirectionEXT;
  mine.t = gl_HitTEXT;
  mine.tmin = gl_RayTminEXT;
  mine.flags = gl_IncomingRayFlagsEXT;
  info = mine;
}
