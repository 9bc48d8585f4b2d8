// Stores which lanes run together in and after every construct.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
layout(local_size_x = 32) in;
layout(set = 0, binding = 0) buffer Results { uint results[]; };
uint here() { return subgroupBallot(true).x; }
uint put_at;
void put(uint x) { results[put_at++] = x; }

// Returns from a switch in a loop, from the loop, and at its end.
uint leave_early(uint x) {
  for (uint i = 0; i < 4; ++i) {
    if (x == i) return i * 10;
    switch (x & 3) {
      case 0: continue;
      case 1: if (i == 2) return 7; break;
      case 2: if (x > 20) break; else return 8;
      default: break;
    }
    if (x > 28 && i == 1) return 9;
  }
  return 99;
}
bool note(bool value, inout uint lanes) { lanes = here(); return value; }

void main() {
  const uint x = gl_SubgroupInvocationID;
  put_at = x * 24;
  if ((x & 1) == 0) put(here()); else put(here());
  put(here());  // 1
  put(leave_early(x));
  put(here());  // 3
  uint last = 0;
  for (uint i = 0; i <= x % 5; ++i) last = here();
  put(last);    // 4
  put(here());
  uint at_step = 0xffffffffu, seen = 0;
  for (uint i = 0; i < 3; ++i, at_step &= here()) {
    if (x % 3 == i) continue;
    seen = here();
  }
  put(at_step); // 6
  put(seen);
  put(here());
  uint first = 0;
  switch (x & 3) {
    case 0: first = here();
    case 1: first += 0; break;
    case 2: first = here(); break;
    default: if (x < 16) break; first = here();
  }
  put(first);   // 9
  put(here());
  uint rounds = 0, together = 0;
  do {
    ++rounds;
    if (rounds > x % 4) {
      if (x > 10) break;
      together = here();
    } else continue;
    if (rounds == 5) break;
  } while (rounds < 6);
  put(rounds);  // 11
  put(here());
  uint left = 0, right = 0;
  const bool both = note(x < 8, left) && note((x & 1) == 0, right);
  put(left);    // 13
  put(right);
  put(both ? here() : 0);
  put(here());  // 16
  for (uint i = 0; i < 8; ++i) {
    switch (i) {
      case 3: if (x >= 24) return; break;
      case 5: if (x < 4) return; break;
      default: break;
    }
    if (i == 4) put(here());  // 17
  }
  put(here());  // 18
}
