// Uses image kinds, layouts, doubles, clocks, locks, loops and switches together.
// SPDX-License-Identifier: Apache-2.0
#version 450
#extension GL_ARB_shader_clock : require
#extension GL_EXT_shader_realtime_clock : require
#extension GL_ARB_gpu_shader_int64 : require
layout(local_size_x = 8, local_size_y = 8) in;
struct Light { vec3 pos; float r; mat4x3 xf; bool on; ivec2 id[2][3]; };
layout(binding = 0, std140) uniform U { mat4 vp; mat3 n; Light lights[4]; int count; dvec3 dv; dmat3x2 dm; } u;
layout(binding = 1, rgba8) uniform image2D img;
layout(binding = 2, r32f) uniform image2D imgs[3];
layout(binding = 3) buffer B { coherent uint lock; volatile uint flag; vec4 data[]; } bf;
layout(binding = 4) uniform sampler2D tex[8];
layout(binding = 5) uniform sampler2DMS ms;
layout(binding = 6) uniform sampler2DArrayShadow sh;
layout(binding = 7) uniform samplerCubeArray ca;
layout(binding = 8) uniform isampler3D i3;
layout(binding = 9) uniform samplerCubeShadow cs;
layout(binding = 10, rg32ui) uniform uimage2DArray ua;
float lut(int i, int j) { const float t[3][2] = float[3][2](float[2](1,2), float[2](3,4), float[2](5,6)); return t[i][j]; }
void change(inout Light l, out float arr[5], int k) { l.pos *= 2.0; l.id[k & 1][k % 3].x += 1; for (int i = 0; i < 5; ++i) arr[i] = float(i * k); }
int deep(int x) { if (x > 3) { if (x > 7) return 1; x *= 2; } for (int i = 0; i < x; ++i) { if (i == 5) return i; if (i == 4) continue; x++; if (x > 30) break; } return x; }
void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  Light l = u.lights[p.x & 3]; float arr[5]; change(l, arr, p.y);
  vec4 c = imageLoad(img, p) + texture(tex[p.x & 7], vec2(p)) + textureProj(tex[0], vec3(p, 2.0)) + textureGradOffset(tex[1], vec2(p), vec2(1), vec2(2), ivec2(1, 2));
  c += textureGatherOffsets(tex[2], vec2(0.5), ivec2[4](ivec2(0), ivec2(1), ivec2(2), ivec2(-1)), 1) + textureGatherOffset(tex[2], vec2(0.5), p, 2);
  c += texelFetch(ms, p, 2) + textureGather(sh, vec3(0.5), 0.3) + texture(sh, vec4(0.5)) + texture(ca, vec4(1, 0, 0, 2)) + vec4(texelFetch(i3, ivec3(1), 0)) + textureGrad(cs, vec4(1), vec3(1), vec3(1));
  c += vec4(imageLoad(ua, ivec3(p, 1)));
  c += vec4(textureSize(ms), textureSamples(ms), textureSize(ca, 0).z);
  c.xyz += inverse(u.n) * l.xf[1] + transpose(u.lights[p.y & 3].xf)[0].xyz + (u.vp * vec4(1)).xyz + mat3(u.vp) * l.pos;
  c.x += determinant(u.vp) + lut(p.x % 3, p.y & 1) + float(deep(p.x)) + arr[p.x % 5] + outerProduct(c, c)[1][2];
  dvec3 d = u.dv * 2.0 + dvec3(u.dm[1], u.dm[0].y) / length(u.dv); c.y += float(d.x + dot(d, d)) + float(u.dm[p.x % 3][p.y & 1]);
  c[p.x & 3] = modf(c.y, c.z); c.w += mod(c.x, 3.0) + (isnan(c.x) ? 1.0 : 2.0) + (isinf(c.y) ? 1 : 0);
  uvec2 t = clock2x32ARB(); uint64_t t2 = clockRealtimeEXT(); c.x += float(t.x) + float(t2);
  bvec3 bb = lessThan(c.xyz, vec3(1)); c.xyz = mix(c.xyz, vec3(2), bb); if (any(bb) && l.on) c = -c;
  while (atomicCompSwap(bf.lock, 0, 1) != 0) { } bf.flag++; atomicExchange(bf.lock, 0);
  switch (p.x) { case 0: case 1: c.x += 1; case 2: c.y += 2; break; case -5: c = vec4(1); break; default: c.z = 1; }
  bf.data[p.y * 8 + p.x] = c; imageStore(imgs[p.x % 3], p, c); imageStore(img, p, c);
}
