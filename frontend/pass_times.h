// Measures the processor time of the stages and passes of a compilation.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "frontend/compile.h"
#include "frontend/virtual_program.h"

namespace glint::frontend {

struct PassTime {
  // This is glslang or reading, which include the validation of what they give; optimiser, validation (of
  // what the optimiser gives), lowering or backend.
  std::string stage;
  std::string pass;    // a part of the stage; empty for a stage without parts
  double seconds = 0;  // processor time of the process
};
using PassTimes = std::vector<PassTime>;

// Adds the processor time of its own life as a row. Without `times` it does nothing.
class PassTimer {
 public:
  PassTimer(PassTimes* times, std::string stage, std::string pass)
      : times_(times), row_{std::move(stage), std::move(pass), 0}, begin_(std::clock()) {}
  ~PassTimer() {
    if (!times_) return;
    row_.seconds = double(std::clock() - begin_) / CLOCKS_PER_SEC;
    times_->push_back(row_);
  }
  PassTimer(const PassTimer&) = delete;
  PassTimer& operator=(const PassTimer&) = delete;

 private:
  PassTimes* times_;
  PassTime row_;
  std::clock_t begin_;
};

// Compiles a file as compile_file() does, without a cache, and returns a row for every pass in the order in
// which they ran. SPIRV-Tools measure their passes themselves, in steps of 10 ms; where they were built
// without that, the optimiser has one row.
PassTimes time_compilation(const std::string& path, const GlslOptions& glsl, const BackendOptions& options,
                           Diagnostics& warnings);

// These functions do what their namesakes without `times` do, and add rows.
std::vector<uint32_t> simplify(std::vector<uint32_t> spirv, const std::string& name, Diagnostics& warnings,
                               Validity validity, PassTimes* times);
isa::Program lower(const std::vector<uint32_t>& spirv, const std::string& name, const BackendOptions& options,
                   const std::string& entry_point, PassTimes* times);
isa::Program assemble(VirtualProgram program, const BackendOptions& options, PassTimes* times);

}  // namespace glint::frontend
