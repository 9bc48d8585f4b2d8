// Nearest neighbours: the distance of every record to a place.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 256) in;
layout(set = 0, binding = 0) readonly buffer Places { vec2 places[]; };  // latitude and longitude
layout(set = 0, binding = 1) writeonly buffer Distances { float distances[]; };
layout(push_constant) uniform Constants { float latitude, longitude; uint records; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= records) return;
  const vec2 away = places[i] - vec2(latitude, longitude);
  distances[i] = sqrt(away.x * away.x + away.y * away.y);
}
