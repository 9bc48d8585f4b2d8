// Names what an issue slot is spent on. Each scheduler gives each of its cycles exactly one of these.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>

namespace glint::core {

// Names the reasons, ordered by nearness to issue. When several warps of a scheduler wait for different
// things, the cycle is given to the first of them in this order, because the warp that was nearest to issue
// is the one that was missed.
enum class Stall : uint8_t {
  Issued,          // An instruction was issued.
  MathThrottle,    // Operands are ready, but the execution pipe still takes the previous instruction.
  RegisterBanks,   // Operands are ready, but the register banks still read those of another instruction.
  LsuThrottle,     // Operands are ready, but a queue or the table of accesses is full, or the policy waits.
  TexThrottle,     // Operands are ready, but the queue of texture instructions is full.
  RtFull,          // Rays are ready, but the RT unit takes no more warps.
  RawFixed,        // The result of an integer, floating-point, move or predicate instruction is missing.
  OperandRead,     // A memory instruction has not read a register yet that is to be overwritten.
  RawSfu,          // The result of the special-function pipe is missing: of a transcendental or a division.
  Const,           // The result of a constant load is missing.
  Branch,          // The target of a branch is not known yet.
  NoInstruction,   // The line of instructions is missing.
  LocalMemory,     // The result of a load from local memory is missing.
  SharedMemory,    // The result of a load from shared memory, or of an atomic on it, is missing.
  Texture,         // The result of a texture or image load is missing.
  LongScoreboard,  // The result of a load from global memory is missing, whichever level answers.
  Call,            // The record of the shader binding table is missing.
  Barrier,   // Other warps have not come to the barrier of the block, or to where threads are regrouped.
  Fence,     // Those that the fence asks for have not seen the warp's earlier accesses yet.
  RtWait,    // The warp is in the RT unit.
  Dispatch,  // The warp is being launched.
  Drain,     // The warp has ended, but its last accesses have not.
  NoWarp,    // No warp is resident.
  Count
};

// Returns whether the result of a load or of an atomic is missing.
constexpr bool waits_for_memory(Stall s) {
  return s >= Stall::LocalMemory && s <= Stall::LongScoreboard;
}

constexpr std::string_view name_of(Stall s) {
  constexpr std::string_view kNames[] = {"issued",         "math_pipe_throttle",
                                         "register_banks", "lsu_throttle",
                                         "tex_throttle",   "rt_full",
                                         "raw_fixed",      "operand_read",
                                         "raw_sfu",        "const",
                                         "branch",         "no_instruction",
                                         "local_memory",   "shared_memory",
                                         "texture",        "long_scoreboard",
                                         "call",           "barrier",
                                         "membar",         "rt_wait",
                                         "dispatch",       "drain",
                                         "no_warp"};
  static_assert(std::size(kNames) == size_t(Stall::Count));
  return kNames[size_t(s)];
}

}  // namespace glint::core
