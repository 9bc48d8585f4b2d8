#version 460
#extension GL_ARB_gpu_shader_int64 : require
#extension GL_ARB_shader_ballot : require
#extension GL_AMD_shader_ballot : require
#extension GL_AMD_shader_trinary_minmax : require
#extension GL_AMD_gcn_shader : require
layout(local_size_x = 32) in;
layout(binding = 0) buffer Out { int results[]; };
layout(binding = 1) buffer In { int values[]; };

// Stores 16 words per thread.
void main() {
  uint self = gl_LocalInvocationIndex, at = self * 16;
  int a = values[self], b = values[(self + 7) & 31], c = values[(self + 19) & 31];
  results[at] = min3(a, b, c);
  results[at + 1] = max3(a, b, c);
  results[at + 2] = mid3(a, b, c);
  results[at + 3] = int(mid3(uint(a), uint(b), uint(c)));
  results[at + 4] = floatBitsToInt(mid3(float(a), float(b), float(c)));
  results[at + 5] = swizzleInvocationsAMD(a, uvec4(3, 0, 1, 1));
  results[at + 6] = swizzleInvocationsMaskedAMD(a, uvec3(29, 2, 16));
  results[at + 7] = writeInvocationAMD(a, b, 5);
  results[at + 8] = int(mbcntAMD(packUint2x32(uvec2(0x0f0f1234u, ~0u))));
  results[at + 9] = addInvocationsAMD(a);
  results[at + 10] = minInvocationsAMD(a);
  results[at + 11] = 0;
  if (a > 0) results[at + 11] = maxInvocationsNonUniformAMD(b) + addInvocationsInclusiveScanNonUniformAMD(a);
  vec3 direction = vec3(float(a), float(b), float(c));
  results[at + 12] = floatBitsToInt(cubeFaceIndexAMD(direction));
  vec2 place = cubeFaceCoordAMD(direction);
  results[at + 13] = floatBitsToInt(place.x);
  results[at + 14] = floatBitsToInt(place.y);
  results[at + 15] = 1;
}
