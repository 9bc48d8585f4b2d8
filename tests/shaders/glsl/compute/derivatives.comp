#version 460
#extension GL_NV_compute_shader_derivatives : require
layout(local_size_x = 8, local_size_y = 8) in;
#ifdef LINEAR
layout(derivative_group_linearNV) in;
#else
layout(derivative_group_quadsNV) in;
#endif
layout(binding = 0) buffer Out { float results[]; };
layout(binding = 1) uniform sampler2D picture;  // three levels, each of one value

// Stores 8 words per thread, by the thread's index.
void main() {
  uint at = gl_LocalInvocationIndex * 8;
  float x = float(gl_LocalInvocationID.x * gl_LocalInvocationID.x), y = float(gl_LocalInvocationID.y * gl_LocalInvocationID.y);
  float f = x + 100.0 * y + x * y;
  results[at] = dFdx(f);
  results[at + 1] = dFdy(f);
  results[at + 2] = fwidth(f);
  results[at + 3] = dFdxCoarse(f);
  results[at + 4] = dFdyCoarse(f);
  results[at + 5] = dFdyFine(vec2(f, -f)).y;
  vec2 place = vec2(gl_LocalInvocationID.xy) * 0.5;  // neighbours are two texels of level 0 apart
  results[at + 6] = texture(picture, place).x;
  results[at + 7] = texture(picture, place, 1.0).x;
}
