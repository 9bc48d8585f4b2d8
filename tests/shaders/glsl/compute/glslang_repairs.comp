// Constants of 8 and 16 bits that are made of specialisation constants, and structures that ?: takes from blocks of other
// layouts. glslang 12 makes invalid SPIR-V of both.
#version 460
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x = 32) in;
layout(constant_id = 0) const float kScale = 1.5;
layout(constant_id = 1) const int kStep = -3;
struct Sample {
  uint number;
  vec3 place;
  uint part[2];
};
layout(set = 0, binding = 0) buffer Samples { Sample samples[32]; };
layout(set = 0, binding = 1) buffer Out { uint o[128]; };
shared Sample kept[32];

void main() {
  const uint lane = gl_LocalInvocationIndex;
  samples[lane] = Sample(100 + lane, vec3(lane), uint[2](7, lane));
  kept[lane] = Sample(200 + lane, vec3(2 * lane), uint[2](9, lane));
  barrier();
  memoryBarrierBuffer();
  const Sample taken = lane > 20 ? kept[lane ^ 1] : samples[lane ^ 1];
  o[4 * lane] = taken.number;
  o[4 * lane + 1] = taken.part[0] * 100 + taken.part[1];
  o[4 * lane + 2] = uint(taken.place.z);
  o[4 * lane + 3] = uint(int16_t(kStep) + int8_t(lane)) ^ packFloat2x16(f16vec2(float16_t(kScale), float16_t(lane)));
}
