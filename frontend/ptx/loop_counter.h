// Finds what a loop of one block counts, and how far.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "frontend/ptx/loop_body.h"

namespace glint::frontend::ptx {

class LoopCounter {
 public:
  LoopCounter(const Draft& draft, const VirtualProgram& program, const LoopBody& body, BlockId at)
      : draft_(draft), program_(program), body_(body), at_(at) {}

  // Finds the counter, which steps by a constant, in a test whose result only the block reads. Returns false
  // if the test is another one.
  bool find(const VirtualInst& test);
  VirtualRegister counter() const { return counter_; }
  const VirtualOperand& end() const { return end_; }  // bound of the counter
  bool is_wide() const { return program_.registers[counter_] == RegisterClass::B64; }

  // Returns the number of turns until the test that find() has found, if it is a constant of at most 256.
  std::optional<int64_t> known_turns(const VirtualInst& test) const;
  // Returns the constant that the register holds when the loop begins, if one block leads to the loop, and it
  // or the blocks that alone lead to it set the register.
  std::optional<uint64_t> start_of(VirtualRegister r) const;
  // Returns true for a sum of a constant and a register that steps: displacements and constants take its
  // place in copies.
  bool vanishes(const VirtualInst& inst) const;

 private:
  const Draft& draft_;
  const VirtualProgram& program_;
  const LoopBody& body_;
  const BlockId at_;
  const Ops ops_;
  VirtualRegister counter_ = kNoRegister;
  VirtualOperand end_;
};

}  // namespace glint::frontend::ptx
