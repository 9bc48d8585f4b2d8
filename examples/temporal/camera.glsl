// Says how the camera sees the scene: it moves to the right from frame to frame and does not turn.
// SPDX-License-Identifier: Apache-2.0
vec3 eye_in(uint frame) { return vec3(-0.3 + 0.06 * float(frame), 1.5, 4.0); }

// Returns the direction of the ray through the middle of a pixel.
vec3 direction_of(ivec2 pixel, ivec2 size) {
  const vec2 at = (vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0;
  return normalize(vec3(at.x, -at.y - 0.4, -2.0));
}

// Returns the pixel in which a point is seen that lies at `offset` from the eye.
ivec2 pixel_of(vec3 offset, ivec2 size) {
  const vec2 at = vec2(offset.x * 2.0 / -offset.z, -(offset.y * 2.0 / -offset.z) - 0.4);
  return ivec2(floor((at + 1.0) * 0.5 * vec2(size)));
}
