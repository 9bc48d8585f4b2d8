// Training of a network, first kernel: 16 inputs of a block times their weights, summed for each hidden unit.
// SPDX-License-Identifier: Apache-2.0
extern "C" __global__ void __block_size__((16, 16, 1))
backprop_forward(const float* inputs, const float* weights, float* sums, unsigned hidden) {
  __shared__ float values[16], products[16][16];
  const unsigned unit = threadIdx.x, i = threadIdx.y, input = blockIdx.x * 16 + i + 1;
  if (unit == 0) values[i] = inputs[input];
  __syncthreads();
  products[i][unit] = weights[input * (hidden + 1) + unit + 1] * values[i];
  __syncthreads();
  for (unsigned reach = 1; reach < 16; reach *= 2) {
    if (i % (2 * reach) == 0) products[i][unit] += products[i + reach][unit];
    __syncthreads();
  }
  if (i == 0) sums[blockIdx.x * hidden + unit] = products[0][unit];
}
