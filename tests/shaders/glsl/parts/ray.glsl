// Computes the lane's ray in the laboratory's scene.
// SPDX-License-Identifier: Apache-2.0
vec3 lane_origin() { return vec3(vec2(gl_LaunchIDEXT.xy) + 0.5, 10.0); }
const vec3 kDown = vec3(0.0, 0.0, -1.0);
