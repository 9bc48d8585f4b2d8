// Lets tests try shaders: source text becomes SPIR-V, virtual code and, for compute shaders, results in a
// buffer.
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

// Holds a folder that is removed with the object.
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

// simplified() compiles `body` after a #version line and the extensions that ray tracing needs. Line 1 of
// `body` is line kFirstLine of the shader.
inline constexpr uint32_t kFirstLine = 5;
std::string source(const std::string& body);

std::vector<uint32_t> simplified(const std::string& ending, const std::string& body);  // ending: ".rgen"
VirtualProgram lowered(const std::string& ending, const std::string& body);
int count(const VirtualProgram& program, std::string_view op);  // number of instructions with that op
int count_markers(const VirtualProgram& program, VirtualInst::Kind kind);

// Runs the `statements` of main in a compute shader with one lane for each of at most 256 `inputs`. The uint
// `x` is the lane's input, and `float f` has the same bits. The value assigned to `uint y` is returned.
// `globals` precede main.
std::vector<uint32_t> run(const std::vector<uint32_t>& inputs, const std::string& statements,
                          const std::string& globals = "", const BackendOptions& options = {});
std::vector<float> run_f32(const std::vector<float>& inputs, const std::string& expression_of_f,
                           const std::string& globals = "");

}  // namespace glint::frontend::lab
