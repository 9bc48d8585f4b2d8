#version 460
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(constant_id = 0) const uint64_t kBig = 5000000000ul;
layout(constant_id = 1) const int kSmall = -3;
layout(constant_id = 2) const double kFraction = 0.75lf;
const uint64_t kSum = kBig + 7ul, kShifted = kBig >> 3;
const int64_t kProduct = int64_t(kSmall) * 3000000000l;
const bool kIsLess = kProduct < 0l;
layout(local_size_x = 32) in;
layout(binding = 0) buffer Out { uint64_t results[]; };

// Nothing before the lowering folds these operations on constants of 64 bits. Both arms use them.
void main() {
  uint at = gl_LocalInvocationIndex * 3;
  if ((gl_LocalInvocationIndex & 1) == 0) {
    results[at] = kSum;
    results[at + 1] = uint64_t(kProduct);
  } else {
    results[at] = kShifted + kSum;
    results[at + 1] = uint64_t(float(kFraction) * 8.0);
  }
  results[at + 2] = kIsLess ? uint64_t(kSmall) : kBig;
}
