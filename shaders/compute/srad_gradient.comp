// Speckle-reducing diffusion, first kernel: differences to the neighbours and the coefficient of diffusion.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0) readonly buffer Image { float image[]; };
layout(set = 0, binding = 1) writeonly buffer North { float north[]; };
layout(set = 0, binding = 2) writeonly buffer South { float south[]; };
layout(set = 0, binding = 3) writeonly buffer West { float west[]; };
layout(set = 0, binding = 4) writeonly buffer East { float east[]; };
layout(set = 0, binding = 5) writeonly buffer Coefficient { float coefficient[]; };
layout(push_constant) uniform Constants { int columns, rows; float speckle, step; };
shared float tile[16][16];

float at(ivec2 local, ivec2 place) {
  const bool is_here = all(greaterThanEqual(local, ivec2(0))) && all(lessThan(local, ivec2(16)));
  const ivec2 inside = clamp(place, ivec2(0), ivec2(columns, rows) - 1);
  return is_here && inside == place ? tile[local.y][local.x] : image[inside.y * columns + inside.x];
}

void main() {
  const ivec2 local = ivec2(gl_LocalInvocationID.xy), place = ivec2(gl_GlobalInvocationID.xy);
  const bool is_inside = place.x < columns && place.y < rows;
  const int index = place.y * columns + place.x;
  if (is_inside) tile[local.y][local.x] = image[index];
  barrier();
  if (!is_inside) return;
  const float mine = tile[local.y][local.x];
  const float n = at(local - ivec2(0, 1), place - ivec2(0, 1)) - mine;
  const float s = at(local + ivec2(0, 1), place + ivec2(0, 1)) - mine;
  const float w = at(local - ivec2(1, 0), place - ivec2(1, 0)) - mine;
  const float e = at(local + ivec2(1, 0), place + ivec2(1, 0)) - mine;
  const float gradient = (n * n + s * s + w * w + e * e) / (mine * mine);
  const float laplacian = (n + s + w + e) / mine;
  const float numerator = 0.5 * gradient - (1.0 / 16.0) * (laplacian * laplacian);
  const float denominator = 1.0 + 0.25 * laplacian;
  const float variation = numerator / (denominator * denominator);
  const float excess = (variation - speckle) / (speckle * (1.0 + speckle));
  coefficient[index] = clamp(1.0 / (1.0 + excess), 0.0, 1.0);
  north[index] = n, south[index] = s, west[index] = w, east[index] = e;
}
