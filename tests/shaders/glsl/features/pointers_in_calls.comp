#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
layout(local_size_x = 32) in;
layout(buffer_reference) buffer Node;
layout(buffer_reference, std430) buffer Node { Node next; uint value; };
layout(push_constant) uniform Constants { Node head; uint count; };
layout(binding = 0) buffer Out { uint results[]; };

// Addresses are arguments and results of functions with early returns in loops.
Node find(Node n, uint k) {
  for (uint i = 0; i < k; ++i) {
    if (uint64_t(n.next) == 0ul) return n;
    n = n.next;
  }
  return n;
}
uint sum(Node n, inout uint steps) {
  uint total = 0;
  while (uint64_t(n) != 0ul) {
    total += find(n, 2).value;
    if (++steps > count) return total;
    n = n.next;
  }
  return total;
}

void main() {
  uint steps = 0;
  results[gl_LocalInvocationIndex] = sum(find(head, gl_LocalInvocationIndex), steps) + steps;
}
