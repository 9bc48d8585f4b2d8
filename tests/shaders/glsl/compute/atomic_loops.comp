#version 460
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require
#extension GL_EXT_shader_16bit_storage : require
#extension GL_EXT_shader_atomic_float : require
#extension GL_EXT_shader_atomic_float2 : require
#extension GL_KHR_memory_scope_semantics : require
layout(local_size_x = 64) in;
layout(binding = 0) buffer Halves { float16_t halves[4]; };
layout(binding = 1) buffer Out { uint results[]; };
layout(binding = 2, r32f) uniform image2D picture;
shared float16_t least;

// The ISA has these ops only as loops of compare and swap.
void main() {
  uint self = gl_LocalInvocationIndex;
  float x = float(self * 37u % 64u) - 20.0;
  if (self == 0) least = float16_t(1000.0);
  barrier();
  atomicMin(least, float16_t(x));
  atomicMin(halves[0], float16_t(x));
  atomicMax(halves[1], float16_t(x));
  if (self != 9) atomicMax(halves[2], float16_t(0.5 * x));
  if (self == 17) results[self] = floatBitsToUint(float(atomicExchange(halves[3], float16_t(x))));
  imageAtomicMax(picture, ivec2(0, 0), x);
  imageAtomicMin(picture, ivec2(1, 0), x);
  barrier();
  if (self == 0) results[0] = floatBitsToUint(float(least));
}
