// Holds what the hit shaders return.
// SPDX-License-Identifier: Apache-2.0
struct Seen {
  vec3 corners[3];
  vec2 candidate;
};
