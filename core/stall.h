// Names what an issue slot is spent on. Each scheduler gives each of its cycles exactly one of these.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>

namespace glint::core {

// Names the reasons, ordered by nearness to issue. When several warps of a scheduler wait for different
// things, the cycle is given to the first of them in this order, because the warp that had least left to wait
// for is what was missed.
enum class Stall : uint8_t {
  Issued,          // an instruction was issued
  MathThrottle,    // operands are ready, but the execution pipe still takes the previous instruction
  RegisterBanks,   // operands are ready, but the banks of the register file still read those of another one
  LsuThrottle,     // operands are ready, but the scheduler's memory queue or the table of accesses is full
  TexThrottle,     // operands are ready, but the queue of texture instructions is full
  RtFull,          // rays are ready, but the RT unit takes no more warps
  RawFixed,        // result of an integer, floating-point, move or predicate instruction
  OperandRead,     // read of a register to overwrite, by a memory instruction that has not read it yet
  RawSfu,          // result of the special-function pipe: transcendentals and divisions
  Const,           // result of a constant load
  Branch,          // target of a branch that is not yet known
  NoInstruction,   // line of instructions
  LocalMemory,     // load from local memory
  SharedMemory,    // load from shared memory, or an atomic on it
  Texture,         // texture or image load
  LongScoreboard,  // load from global memory, whichever level answers
  Call,            // record of the shader binding table
  Barrier,         // other warps of the block that have not come
  Fence,           // earlier accesses of the warp, not yet seen by those that the fence asks for
  RtWait,          // the warp is in the RT unit
  Dispatch,        // the warp is being launched
  Drain,           // the warp has ended, but its last accesses have not
  NoWarp,          // no warp is resident
  Count
};

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
