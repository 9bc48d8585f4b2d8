#version 460
layout(local_size_x = 32) in;
layout(binding = 0, std430) buffer Out { uint words[]; };

uint shared_by_all[8];

void bump(inout uint a[8], uint at) { a[at & 7u] += 1u + at; }
void twice(inout uint a[8], uint at) {
  bump(a, at);
  if (a[1] > 20u) return;
  bump(a, at + 3u);
  a[2] ^= 5u;
}
void both(inout uint a[8], inout uint b[8]) {
  a[0] += 100u;
  b[0] += b[0];
  a[1] = b[0];
}
void part(inout uint a[8], inout uint element) {
  a[3] = 7u;
  element += 1u;
}
void part_first(inout uint element, inout uint a[8]) {
  a[3] = 9u;
  element += 1u;
}
uint alias(inout uint a[8]) {
  a[0] = 5u;
  return shared_by_all[0];
}
uint changed(inout uint a[8]) { return a[4] += 3u; }
void add(inout uint a[8], uint what) { a[5] += what; }

void main() {
  const uint lane = gl_LocalInvocationIndex;
  uint a[8], b[8];
  for (uint i = 0u; i < 8u; ++i) {
    a[i] = lane + i;
    b[i] = lane * i;
    shared_by_all[i] = lane ^ i;
  }
  twice(a, lane);
  both(a, b);
  const uint second = a[0] + b[0];
  both(b, b);
  part(a, a[3]);
  part_first(b[3], b);
  add(a, changed(a));
  const uint old = alias(shared_by_all);
  for (uint i = 0u; i < 8u; ++i) words[lane * 32u + i] = a[i], words[lane * 32u + 8u + i] = b[i];
  words[lane * 32u + 16u] = second;
  words[lane * 32u + 17u] = old;
  words[lane * 32u + 18u] = shared_by_all[0];
}
