// Uses arrays and structs of locals and globals, textures passed to functions, and loops left in several ways.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 32) in;
layout(binding = 0) buffer B { float o[]; };
layout(binding = 1) uniform sampler2D t; layout(binding = 2) uniform texture2DArray ta; layout(binding = 3) uniform sampler s; layout(binding = 4) uniform samplerShadow ss; layout(binding = 5) uniform texture2D td;
layout(binding = 6, rgba16f) readonly uniform image2D im[4]; layout(binding = 7) uniform sampler2D tt[6]; layout(binding = 8, r32i) uniform iimage2DArray ia; layout(binding = 9, rgba32f) uniform imageCubeArray ica; layout(binding = 10) uniform usamplerBuffer ub; layout(binding = 11) uniform itexture1DArray i1;
struct M { float a[3]; mat2 m[2]; };
M gm; vec4 gv[4]; const vec2 offs[4] = vec2[](vec2(0), vec2(1), vec2(2), vec2(3));
vec4 tap(texture2D x, vec2 uv) { return textureLod(sampler2D(x, s), uv, 0.5); }
vec4 tap2(sampler2D x, vec2 uv) { return textureLod(x, uv, 0.5); }
float rec(float x, int d) { for (int i = 0; i < d; ++i) { for (int j = 0; j < i; ++j) { if (x > 10.0) return x; if (j == 3) break; x += float(j); } if (x < 0.0) continue; x *= 2.0; } return -x; }
void main() {
  uint i = gl_GlobalInvocationID.x; vec4 c = tap(td, vec2(0.1)) + tap2(t, vec2(i)) + tap2(tt[3 + i % 3], vec2(1));
  c += textureLod(sampler2DArray(ta, s), vec3(0), 1.0) + texture(sampler2DShadow(td, ss), vec3(0.5)) + imageLoad(im[2 + (i & 1)], ivec2(i)) + vec4(imageLoad(ia, ivec3(i))) + imageLoad(ica, ivec3(i)) + vec4(texelFetch(ub, 3)) + vec4(texelFetch(isampler1DArray(i1, s), ivec2(1, 2), 0));
  gm.a[i % 3] = c.x; gm.m[i & 1][1].x = 2.0; M lm = gm; lm.m[1] *= lm.m[0]; gv[i & 3] = c; vec4 arr[4] = gv; arr[(i + 1) & 3].yz = offs[i & 3];
  c += arr[i & 3] + vec4(lm.m[i & 1][0], lm.a[1], rec(c.x, int(i)));
  do { c.x -= 1.0; if (c.x < 3.0) { c.y = 1.0; continue; } c.z += 1.0; } while (c.x > 0.0);
  for (;;) { c.w += 1.0; if (c.w > 5.0) { if (c.x > 1.0) break; else { c.y = 2.0; o[i] = 1.0; return; } } }
  o[i] = dot(c, vec4(1));
}
