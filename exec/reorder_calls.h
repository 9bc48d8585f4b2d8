// Runs *.reorder: reads what the lanes of a warp say about the code that they will run next.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "exec/fault_gate.h"
#include "exec/warp_context.h"
#include "isa/op_row.h"

namespace glint::exec {

// Holds what one lane says. The pointers are null when there is no ray or no hit, and are valid until the
// warp executes its next instruction.
struct ReorderCall {
  // Says what the hit object or the ray holds. Hint: the shader gave no hit object.
  enum class Found : uint8_t { Hint, Nothing, Hit, Miss } found = Found::Hint;
  uint32_t record = 0;  // number of the record in the hit region or the miss region
  uint32_t hint = 0;    // only the bits that count; 0 without a hint
  uint32_t bits = 0;    // number of bits of the hint: 0 to 32
  const rt::Ray* ray = nullptr;
  const rt::Hit* hit = nullptr;
};

// The effect of these ops is that a core may move the threads of a warp to other lanes and warps afterwards.
// This class moves nothing.
class ReorderCalls {
 public:
  ReorderCalls(const World& world, FaultGate& faults) : world_(world), faults_(faults) {}

  // Returns false after a fault.
  bool run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);

  // These are of the last run(): what each executing lane said, and the registers and bytes of stack that
  // move with a thread.
  const std::array<ReorderCall, kLanes>& calls() const { return calls_; }
  uint32_t live_registers() const { return live_registers_; }
  uint32_t stack_bytes() const { return stack_bytes_; }

 private:
  bool read_objects(WarpContext& warp, const isa::Inst& inst);
  void read_hints(const WarpContext& warp, const isa::Inst& inst, size_t operand);
  void read_trace(const WarpContext& warp);

  const World& world_;
  FaultGate& faults_;
  std::array<ReorderCall, kLanes> calls_{};
  uint32_t live_registers_ = 0, stack_bytes_ = 0;
};

}  // namespace glint::exec
