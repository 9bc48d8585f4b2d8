// Declares the results of a lane: WORDS words.
// SPDX-License-Identifier: Apache-2.0
#ifndef WORDS
#define WORDS 8
#endif
layout(set = 0, binding = 1, std430) buffer Results { uint results[]; };
uint lane_index() { return gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x; }
void put(uint at, uint value) { results[lane_index() * WORDS + at] = value; }
void put(uint at, int value) { put(at, uint(value)); }
void put(uint at, float value) { put(at, floatBitsToUint(value)); }
#include "../parts/ray.glsl"
