// Prints in a function.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_debug_printf : require
layout(local_size_x = 32) in;
layout(set = 0, binding = 0) buffer Results { uint results[]; };
struct Pair { uint a, b; };
Pair twice(Pair p) { Pair q = p; q.a *= 2; debugPrintfEXT("a %d", q.a); return q; }
void main() { results[gl_LocalInvocationID.x] = twice(Pair(gl_LocalInvocationID.x, 1)).a; }
