// Training of a network, second kernel: adjusts the weights by the errors of the hidden units.
// SPDX-License-Identifier: Apache-2.0
extern "C" __global__ void __block_size__((16, 16, 1))
backprop_adjust(const float* inputs, float* weights, float* changes, const float* errors, unsigned hidden) {
  const unsigned unit = threadIdx.x + 1, input = blockIdx.x * 16 + threadIdx.y + 1;
  const unsigned index = input * (hidden + 1) + unit;
  const float change = 0.3f * errors[unit] * inputs[input] + 0.3f * changes[index];
  weights[index] += change;
  changes[index] = change;
  if (input != 1) return;
  const float bias = 0.3f * errors[unit] + 0.3f * changes[unit];  // input 0 is always 1
  weights[unit] += bias;
  changes[unit] = bias;
}
