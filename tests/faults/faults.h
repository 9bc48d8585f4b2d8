// Says what a mistake should do: stop the run with a message, or be noted and give zeros, on both machines.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/shaders/ray_lab.h"

namespace glint::test {

struct Mistake {
  std::string code;  // what WRONG stands for
  std::string what;  // part of the message
  exec::FaultKind kind = exec::FaultKind::OutOfBounds;
  uint64_t count = 0;  // number of lanes that do it
  std::array<uint32_t, 3> first{};
  std::function<uint32_t(uint32_t lane)> result;  // result of a run that goes on
};

// Runs WRONG = `code` and returns the results. What was let pass goes to `faults`.
using RunWrong = std::function<std::vector<uint32_t>(const std::string& code, const LabOptions& options,
                                                     exec::FaultLog& faults)>;
// Checks a mistake. `place` is the end of the shader's file name, and the line.
void check_mistake(const Mistake& mistake, const std::string& place, const RunWrong& run);
LabOptions fault_options(bool timing, exec::OnFault on_fault = exec::OnFault::Stop);
// Returns the message of the fault that ends a run, or "" when none does.
std::string fault_of(const std::string& code, const LabOptions& options, const RunWrong& run);

}  // namespace glint::test
