// The order of the op families in the table; the same on every SIMD path.
// SPDX-License-Identifier: Apache-2.0
#include "isa/ops/families.h"

#include <span>

#include "isa/op_makers.h"

namespace glint::isa::GLINT_ISA_PATH {

void run_nothing(Warp&, const Inst&) {
}

std::span<const FamilyEntry> family_entries() {
  static constexpr FamilyEntry kFamilies[] = {
      {"move", "Copies, selections, and the packing of register pairs.", &move_rows},
      {"integer", "Integer arithmetic of 16, 32 and 64 bits, logic and shifts.", &integer_rows},
      {"bits", "Bit fields, counts, permutations and three-input logic.", &bits_rows},
      {"packed",
       "Bytes and half words of a register at once: video ops, dot products, pairs of 16-bit integers.",
       &packed_rows},
      {"carry", "Arithmetic that hands a carry on, in a predicate.", &carry_rows},
      {"compare", "Comparisons of integers; the result is a predicate, or a value of set.", &compare_rows},
      {"compare floats", "Comparisons of floats; a NaN makes them false, but true if the relation ends in u.",
       &compare_float_rows},
      {"float", "Single precision. A NaN result is 0x7fffffff; subnormals are kept without .ftz.",
       &float_rows},
      {"double", "Double precision. NaNs keep their payload.", &double_rows},
      {"half", "Floats of 16 bits, alone and in pairs. A NaN result is 0x7fff.", &half_rows},
      {"approximate",
       "Special functions as the hardware approximates them, and those of GLSL, nearly correctly rounded.",
       &approximate_rows},
      {"convert", "Conversions between integers; bytes fill a register, extended.", &convert_rows},
      {"convert to integer", "Conversions of floats to integers: rounded, then clamped.",
       &convert_to_integer_rows},
      {"convert from integer", "Conversions of integers to floats.", &convert_from_integer_rows},
      {"convert floats", "Conversions between floats, and rounding to integers.", &convert_float_rows},
      {"convert packed", "Conversions that pack results, and the formats of tensor cores.",
       &convert_packed_rows},
      {"predicate", "Operations on predicates.", &predicate_rows},
      {"memory", "Loads and stores; an address is a register (pair) and a displacement.", &memory_rows},
      {"atomic", "Read-modify-write of memory; lanes take turns, the lowest first.", &atomic_rows},
      {"warp", "Lanes that read each other: shuffles, votes, matches and reductions.", &warp_rows},
      {"barrier", "Waiting for the other warps of the block, and ordering memory accesses.", &barrier_rows},
      {"texture", "Filtered texture fetches, texel fetches, gathers, and what a texture is like.",
       &texture_rows},
      {"surface", "Texels of storage images: loads, stores and atomics.", &surface_rows},
      {"control", "Branches, calls, regions whose lanes meet again, and ends.", &control_rows},
      {"ray tracing", "Rays, and the calls of the shaders they find.", &ray_tracing_rows},
      {"ray query", "Rays that a shader walks itself, candidate by candidate.", &ray_query_rows},
      {"hit object", "What a ray found, kept until its shader is executed.", &hit_object_rows},
      {"print", "Text for whoever debugs the shader.", &print_rows},
  };
  return kFamilies;
}

}  // namespace glint::isa::GLINT_ISA_PATH
