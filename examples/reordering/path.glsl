// What the shaders of the example have in common: the path that a ray follows, and the patterns of the walls.
// SPDX-License-Identifier: Apache-2.0
struct Path {
  vec3 origin, direction;
  vec3 weight, light;
  uint random;
  bool goes_on;
};

uint next_random(inout uint state) {
  state = state * 747796405u + 2891336453u;
  const uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
  return (word >> 22) ^ word;
}
float random01(inout uint state) { return float(next_random(state) >> 8) / 16777216.0; }

// Returns which of four patterns a place of a wall has: 0 to 3.
uint pattern_at(vec3 place) {
  const ivec3 cell = ivec3(floor(place * 1.5 + 0.01));
  uint hash = uint(cell.x) * 73856093u ^ uint(cell.y) * 19349663u ^ uint(cell.z) * 83492791u;
  return next_random(hash) & 3u;
}
