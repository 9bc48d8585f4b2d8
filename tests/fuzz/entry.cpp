// Checks the properties that every input must have.
// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/entry.h"

#include "base/check.h"
#include "base/diagnostics.h"
#include "isa/text.h"
#include "isa/verify.h"
#include "tests/fuzz/tiny_world.h"

namespace glint::fuzz {
namespace {

// A warp may run this many instructions: enough for every op of a short program and some rounds of a loop.
constexpr uint64_t kInstructions = 2000;

bool is_sound(const isa::Program& program) {
  Diagnostics diagnostics;
  isa::verify(program, diagnostics);
  return !diagnostics.has_errors();
}

void survives_text(const isa::Program& program) {
  const std::string text = isa::to_text(program);
  try {
    GLINT_CHECK(isa::parse(text, "again") == program, "another program than that of\n{}", text);
  } catch (const UserError& error) {
    GLINT_PANIC("the text of a program is refused: {}\n{}", error.what(), text);
  }
}

Reached run_if_sound(const isa::Program& program) {
  if (!is_sound(program)) return Reached::Parsed;
  survives_text(program);
  if (!can_run(program)) return Reached::Verified;
  const std::string fault = run(program, kInstructions);
  for (const char* broken : {"without its ssy", "that was not called"})
    GLINT_CHECK(fault.find(broken) == std::string::npos, "the verifier accepted what faults so: {}\n{}",
                fault, isa::to_text(program));
  return Reached::Ran;
}

}  // namespace

Reached assembly(const std::string& text) {
  isa::Program program;
  try {
    program = isa::parse(text, "fuzz");
  } catch (const UserError&) {
    return Reached::Refused;
  }
  survives_text(program);
  return run_if_sound(program);
}

Reached program(std::span<const uint8_t> bytes) {
  return run_if_sound(program_of(bytes));
}

}  // namespace glint::fuzz
