// Forces between particles: a block has a box of space, and looks at its particles and those of its neighbours.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 128) in;
layout(set = 0, binding = 0) readonly buffer Places { vec4 places[]; };  // x, y, z and half of the square
layout(set = 0, binding = 1) readonly buffer Charges { float charges[]; };
layout(set = 0, binding = 2) readonly buffer Neighbours { uint neighbours[]; };  // 27 a box; 0xffffffff: none
layout(set = 0, binding = 3) writeonly buffer Forces { vec4 forces[]; };  // energy in w
layout(push_constant) uniform Constants { uint particles; float twice_alpha_squared; };
shared vec4 near_places[128];
shared float near_charges[128];

void main() {
  const uint i = gl_LocalInvocationID.x, first = gl_WorkGroupID.x * particles;
  const bool is_particle = i < particles;
  const vec4 mine = is_particle ? places[first + i] : vec4(0);
  vec4 force = vec4(0);
  for (uint k = 0; k < 27; ++k) {
    const uint box = neighbours[gl_WorkGroupID.x * 27 + k];
    if (box == 0xffffffffu) continue;  // This holds for the whole block.
    barrier();
    if (is_particle) {
      near_places[i] = places[box * particles + i];
      near_charges[i] = charges[box * particles + i];
    }
    barrier();
    if (!is_particle) continue;
    for (uint j = 0; j < particles; ++j) {
      const vec4 other = near_places[j];
      const float dot_product = mine.x * other.x + mine.y * other.y + mine.z * other.z;
      const float u = exp(-twice_alpha_squared * (mine.w + other.w - dot_product));
      const float scale = 2.0 * near_charges[j] * u;
      force.x += scale * (mine.x - other.x);
      force.y += scale * (mine.y - other.y);
      force.z += scale * (mine.z - other.z);
      force.w += near_charges[j] * u;
    }
  }
  if (is_particle) forces[first + i] = force;
}
