// Runs one module on the interpreter and on both machines, in all the ways a program may be compiled, and
// compares.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/torture/interpreter.h"

namespace glint::test::torture {

struct Way {
  uint32_t max_registers = 64;
  bool schedule = true;
  bool timing = false;
  bool simplified =
      true;  // by the optimiser's passes; else lowered as it is, which a module without calls can be
  std::string to_string() const;
};

struct Trial {
  std::string name;
  std::vector<uint32_t> spirv;
  std::vector<uint32_t> simplified;  // filled by the first comparison that needs it
  ScalarLaunch launch;               // with the buffers as they are at the start
  uint32_t words_a_lane = 1;         // of the results
};

// The buffers after the launch. glint::Error for whatever goes wrong.
std::map<uint32_t, std::vector<uint32_t>> run_machine(Trial& trial, const Way& way);

// What differs from the interpreter's run of the same words, or is thrown; empty when nothing is. `expected`
// is the launch after the interpreter's run.
std::string difference(Trial& trial, const ScalarLaunch& expected, const Way& way);

// The whole comparison, on every way given; the first difference.
struct Verdict {
  std::string problem;        // empty: all agree
  bool skipped = false;       // it runs too long, or the validator refuses it: nothing was compared
  uint64_t steps = 0;         // of the longest lane
  bool lanes_differ = false;  // in their results
};
Verdict judge(Trial& trial, const std::vector<Way>& ways);

}  // namespace glint::test::torture
