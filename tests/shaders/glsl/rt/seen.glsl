// Declares what the shaders of a ray saw in their records.
// SPDX-License-Identifier: Apache-2.0
#extension GL_EXT_ray_cull_mask : require
struct Seen {
  uint closest, any, intersection, miss, again, mask;
};
