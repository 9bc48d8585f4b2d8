// Declares a way to run a shader from its text, with one storage buffer of words, and to keep what it prints.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "exec/print_log.h"
#include "frontend/compile.h"
#include "isa/program.h"

namespace glint::test {

struct ShaderRun {
  frontend::BackendOptions backend;
  frontend::GlslOptions glsl;
  isa::Stage stage = isa::Stage::Compute;
  std::array<uint32_t, 3> size{1, 1, 1};  // blocks or rays
  uint64_t print_limit = 1000;
  bool timing = false;
  std::vector<uint32_t> words;  // contents of set 0 binding 0, before and after the run
};

isa::Program compile_text(const ShaderRun& run, const std::string& text);
// Returns what PrintLog::take() gives.
std::string run_text(ShaderRun& run, const std::string& text);
std::string run_program(ShaderRun& run, const isa::Program& program);

}  // namespace glint::test
