// Gives the order of the op families in the table, which is the same on every SIMD path.
// SPDX-License-Identifier: Apache-2.0
#include "isa/ops/families.h"

#include <span>

#include "isa/op_makers.h"

namespace glint::isa::GLINT_ISA_PATH {

void run_nothing(Warp&, const Inst&, const OpRow&) {
}

std::span<const FamilyEntry> family_entries() {
  static constexpr FamilyEntry kFamilies[] = {
      {"move", "These ops copy, select, and pack register pairs.", &move_rows},
      {"integer", "These ops are integer arithmetic of 16, 32 and 64 bits, logic and shifts.", &integer_rows},
      {"bits", "These ops are bit fields, counts, permutations and three-input logic.", &bits_rows},
      {"fused", "These ops do two operations in one instruction, as GPUs do. PTX has no names for them.",
       &fused_rows},
      {"packed",
       "These ops handle all bytes or half words of a register: video ops, dot products, pairs of integers.",
       &packed_rows},
      {"carry", "These ops are arithmetic that passes a carry in a predicate.", &carry_rows},
      {"compare", "These ops compare integers. The result is a predicate, or a value for set.",
       &compare_rows},
      {"compare floats",
       "These ops compare floats. With a NaN they are false, except relations that end in u.",
       &compare_float_rows},
      {"float",
       "These ops are single precision. A NaN result is 0x7fffffff. Subnormals are kept without .ftz.",
       &float_rows},
      {"double", "These ops are double precision. NaNs keep their payload.", &double_rows},
      {"half", "These ops handle floats of 16 bits, alone and in pairs. A NaN result is 0x7fff.", &half_rows},
      {"approximate",
       "These ops are special functions: the hardware's approximations, and GLSL's, nearly correctly "
       "rounded.",
       &approximate_rows},
      {"convert", "These ops convert between integers. Bytes are extended to fill a register.",
       &convert_rows},
      {"convert to integer", "These ops convert floats to integers, rounded and then clamped.",
       &convert_to_integer_rows},
      {"convert from integer", "These ops convert integers to floats.", &convert_from_integer_rows},
      {"convert floats", "These ops convert between floats, and round to integers.", &convert_float_rows},
      {"convert packed", "These ops convert and pack results, also in the formats of tensor cores.",
       &convert_packed_rows},
      {"predicate", "These ops work on predicates.", &predicate_rows},
      {"memory", "These ops load and store. An address is a register (pair) and a displacement.",
       &memory_rows},
      {"atomic", "These ops read, modify and write memory. Lanes take turns, the lowest first.",
       &baseline::atomic_rows},
      {"warp", "In these ops lanes read each other: shuffles, votes, matches and reductions.", &warp_rows},
      {"tensor", "These ops multiply matrices that the lanes of a warp hold together.", &tensor_rows},
      {"matrix access", "These ops load and store matrices of a warp.", &baseline::matrix_access_rows},
      {"barrier", "These ops wait for the other warps of the block, and order memory accesses.",
       &baseline::barrier_rows},
      {"asynchronous", "These ops copy to shared memory while the warp goes on, and wait at barriers there.",
       &baseline::async_rows},
      {"texture", "These ops filter textures, fetch and gather texels, and query textures.",
       &baseline::texture_rows},
      {"surface", "These ops load, store and change texels of storage images.", &baseline::surface_rows},
      {"control", "These ops are branches, calls, regions whose lanes meet again, and ends.",
       &baseline::control_rows},
      {"ray tracing", "These ops trace rays and call the shaders that the rays find.",
       &baseline::ray_tracing_rows},
      {"ray query", "With these ops a shader walks rays itself, candidate by candidate.",
       &baseline::ray_query_rows},
      {"hit object", "These ops keep what a ray found until its shader is executed.",
       &baseline::hit_object_rows},
      {"print", "These ops print text for debugging a shader.", &baseline::print_rows},
  };
  return kFamilies;
}

}  // namespace glint::isa::GLINT_ISA_PATH
