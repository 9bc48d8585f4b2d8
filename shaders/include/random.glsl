// Makes random numbers: the Tiny Encryption Algorithm as a hash, a linear congruential generator, and rejection.
// SPDX-License-Identifier: Apache-2.0
#ifndef GLINT_RANDOM_GLSL
#define GLINT_RANDOM_GLSL

// Hashes two words with the algorithm of Wheeler and Needham 1994 in 16 rounds and LumiBench's key. Returns the first word.
uint hash_pair(uint first, uint second) {
  uint sum = 0u;
  for (int round = 0; round < 16; ++round) {
    sum += 0x9e3779b9u;
    first += ((second << 4) + 0xa341316cu) ^ (second + sum) ^ ((second >> 5) + 0xc8013ea4u);
    second += ((first << 4) + 0xad90777du) ^ (first + sum) ^ ((first >> 5) + 0x7e95761eu);
  }
  return first;
}

// Returns a number in [0, 1) from the low 24 bits of the next state.
float random_float(inout uint state) {
  state = 1664525u * state + 1013904223u;
  return float(state & 0x00ffffffu) / 16777216.0;
}

// Each statement draws once, because GLSL does not define the order of evaluation inside a constructor.
vec2 random_in_unit_disk(inout uint state) {
  vec2 point;
  do {
    point.x = 2.0 * random_float(state) - 1.0;
    point.y = 2.0 * random_float(state) - 1.0;
  } while (dot(point, point) >= 1.0);
  return point;
}

vec3 random_in_unit_sphere(inout uint state) {
  vec3 point;
  do {
    point.x = 2.0 * random_float(state) - 1.0;
    point.y = 2.0 * random_float(state) - 1.0;
    point.z = 2.0 * random_float(state) - 1.0;
  } while (dot(point, point) >= 1.0);
  return point;
}

#endif
