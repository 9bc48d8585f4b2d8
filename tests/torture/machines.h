// Runs one module on the interpreter and on both machines, in all ways of compiling it, and compares.
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
  // The optimiser's passes simplify the module. Otherwise it is lowered as it is, which is possible for a
  // module without calls.
  bool simplified = true;
  std::string to_string() const;
};

struct Trial {
  std::string name;
  std::vector<uint32_t> spirv;
  std::vector<uint32_t> simplified;  // filled by the first comparison that needs it
  ScalarLaunch launch;               // buffers have their contents at the start
  uint32_t words_a_lane = 1;         // words per lane in the results
};

// Returns the buffers after the launch. Throws glint::Error for whatever goes wrong.
std::map<uint32_t, std::vector<uint32_t>> run_machine(Trial& trial, const Way& way);

// Returns what differs from the interpreter's run of the same words, or is thrown, or "" when nothing does.
// `expected` is the launch after the interpreter's run.
std::string difference(Trial& trial, const ScalarLaunch& expected, const Way& way);

// Holds the result of the whole comparison on every given way: the first difference.
struct Verdict {
  std::string problem;        // empty when all agree
  bool skipped = false;       // nothing was compared, because it runs too long or the validator refuses it
  uint64_t steps = 0;         // steps of the longest lane
  bool lanes_differ = false;  // the lanes' results differ
};
Verdict judge(Trial& trial, const std::vector<Way>& ways);

}  // namespace glint::test::torture
