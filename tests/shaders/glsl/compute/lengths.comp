// Uses arrays whose lengths depend on specialisation constants and are 0 by default, in a function with several returns.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 32) in;
layout(constant_id = 1) const uint kWidth = 32;
layout(constant_id = 2) const uint kSplit = 64;
const uint kParts = kWidth / kSplit;
shared uint sums[kParts][32];
layout(binding = 0) buffer Out { uint results[]; };
uint part(uint own[kParts], uint i) {
  for (uint k = 0u; k < kParts; ++k)
    if (k == i) return own[k];
  return 7u;
}
void main() {
  uint own[kParts];
  for (uint i = 0u; i < kParts; ++i) own[i] = gl_LocalInvocationID.x + 100u * i;
  for (uint i = 0u; i < kParts; ++i) sums[i][gl_LocalInvocationID.x] = part(own, i);
  barrier();
  uint sum = part(own, kParts);
  for (uint i = 0u; i < kParts; ++i) sum += sums[i][gl_LocalInvocationID.x ^ 1u];
  results[gl_LocalInvocationID.x] = sum;
}
