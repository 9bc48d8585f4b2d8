// A function that the frontend does not support.
// SPDX-License-Identifier: Apache-2.0

uint highest(uint x) {
  return atomicMax(counter.n, x);
}
