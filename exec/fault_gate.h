// Decides what happens when a program does something wrong: the run stops, or the lane goes on.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "exec/fault.h"
#include "exec/warp_context.h"

namespace glint::exec {

// Holds the fault. Functions of the executor's families return false after a fault that ends the run, as
// fail() does.
class FaultGate {
 public:
  explicit FaultGate(const World& world) : world_(world) {}

  // Ends the run. Always returns false.
  bool fail(const WarpContext& warp, int lane, std::string what);
  bool fail(Fault fault);
  // Returns false when the mistake ends the run, as World::on_fault says. Returns true when the mistake is
  // noted and the lane goes on without effect.
  bool let_pass(const WarpContext& warp, int lane, FaultKind kind, const std::function<std::string()>& what);

  const std::optional<Fault>& fault() const { return fault_; }
  const FaultLog& passed() const { return passed_; }

 private:
  const World& world_;
  std::optional<Fault> fault_;
  FaultLog passed_;
};

// Returns the fault of a warp that has run for longer than any real program, at the instruction `pc`.
Fault no_end_in_sight(const World& world, const WarpContext& warp, uint32_t pc, uint64_t instruction_budget);

}  // namespace glint::exec
