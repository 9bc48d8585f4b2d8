// A place to try shaders: source text to SPIR-V, to virtual code, and - for compute - to results in a buffer.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "frontend/compile.h"
#include "frontend/lower/lowering.h"

namespace glint::frontend::lab {

// A folder that goes away with the object.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string write(const std::string& name, const std::string& text) const;  // returns the path

 private:
  std::filesystem::path path_;
};

// `body` behind the #version line and the extensions that ray tracing needs. Line 1 of `body` is line
// kFirstLine.
inline constexpr uint32_t kFirstLine = 5;
std::string source(const std::string& body);

std::vector<uint32_t> simplified(const std::string& ending, const std::string& body);  // ending: ".rgen"
VirtualProgram lowered(const std::string& ending, const std::string& body);
int count(const VirtualProgram& program, std::string_view op);  // instructions of that op
int count_markers(const VirtualProgram& program, VirtualInst::Kind kind);

// Runs main's `statements` in a compute shader, one lane an element of `inputs` (at most 256): the uint `x`
// is the lane's input, `float f` its bits as a float; what is assigned to `uint y` comes back. `globals`
// precede main.
std::vector<uint32_t> run(const std::vector<uint32_t>& inputs, const std::string& statements,
                          const std::string& globals = "", const BackendOptions& options = {});
std::vector<float> run_f32(const std::vector<float>& inputs, const std::string& expression_of_f,
                           const std::string& globals = "");

}  // namespace glint::frontend::lab
