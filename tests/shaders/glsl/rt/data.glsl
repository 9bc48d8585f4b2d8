// Declares callable data and record data of several types.
// SPDX-License-Identifier: Apache-2.0
struct Job {
  uint depth;
  bool odd;
  uint trail[3];
  vec2 sum;
};
struct Tag {
  uint tag;
  vec3 weight;
};
