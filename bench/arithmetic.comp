// Calculates and does little else: a recurrence of floats beside one of integers, with one store at the end.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 128) in;
layout(binding = 0, std430) buffer Results { float results[]; };

void main() {
  const uint thread = gl_GlobalInvocationID.x;
  float x = float(thread) * 1e-5, y = 0.5;
  uint random = thread;
  for (int step = 0; step < 500; ++step) {
    const float next = x * x - y * y + 0.3;
    y = min(2.0 * x * y + 0.1, 2.0);
    x = min(next, 2.0);
    random = random * 1664525u + 1013904223u;
    random ^= random >> 7;
  }
  results[thread] = x + y + float(random & 255u);
}
