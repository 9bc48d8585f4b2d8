// Runs a script and says whether it passed.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "amber/launch.h"

namespace glint::amber {

enum class Verdict : uint8_t { Passed, Failed, Unsupported };

struct Outcome {
  Verdict verdict = Verdict::Passed;
  Exit exit = Exit::Ok;             // Failure: an expectation does not hold; otherwise the kind of error
  std::string message;              // with file and line; empty when passed
  std::vector<std::string> faults;  // faults of all launches that OnFault::Warn let pass
  std::string printed;              // output of the shaders of all launches, in order of the launches
  uint64_t cycles = 0;              // cycles of all launches on the timing machine
  uint32_t launches = 0, expectations = 0;
};

// Makes it the outcome of a script that ended with an error.
void note(Outcome& outcome, const Error& error);

// Runs a script. It throws nothing for mistakes in the script.
Outcome run_script(const std::string& path, const LaunchOptions& options);
Outcome run_script(Script script, const LaunchOptions& options);

}  // namespace glint::amber
