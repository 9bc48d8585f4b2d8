// Speckle-reducing diffusion, second kernel: the divergence moves each pixel.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0) buffer Image { float image[]; };
layout(set = 0, binding = 1) readonly buffer North { float north[]; };
layout(set = 0, binding = 2) readonly buffer South { float south[]; };
layout(set = 0, binding = 3) readonly buffer West { float west[]; };
layout(set = 0, binding = 4) readonly buffer East { float east[]; };
layout(set = 0, binding = 5) readonly buffer Coefficient { float coefficient[]; };
layout(push_constant) uniform Constants { int columns, rows; float speckle, step; };
shared float tile[16][16];

void main() {
  const ivec2 local = ivec2(gl_LocalInvocationID.xy), place = ivec2(gl_GlobalInvocationID.xy);
  const bool is_inside = place.x < columns && place.y < rows;
  const int index = place.y * columns + place.x;
  if (is_inside) tile[local.y][local.x] = coefficient[index];
  barrier();
  if (!is_inside) return;
  const float mine = tile[local.y][local.x];
  float below = mine, right = mine;
  if (place.y + 1 < rows) below = local.y < 15 ? tile[local.y + 1][local.x] : coefficient[index + columns];
  if (place.x + 1 < columns) right = local.x < 15 ? tile[local.y][local.x + 1] : coefficient[index + 1];
  const float divergence = mine * north[index] + below * south[index] + mine * west[index] + right * east[index];
  image[index] += 0.25 * step * divergence;
}
