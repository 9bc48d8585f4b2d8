// Compiles the shaders of a description, and finds what each of them asks for and where in its text.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "frontend/spirv/reflection.h"
#include "frontend/spirv/specialize.h"
#include "pipeline/description/description.h"
#include "pipeline/params.h"

namespace glint::pipeline {

struct ShaderModule {
  std::string name, path;
  std::string text;  // GLSL source; empty for SPIR-V
  frontend::Reflection reflection;
  std::vector<frontend::SpecConstant> constants;
  isa::Program program;

  // Returns the place of the declaration of a binding or of the push constants, such as "shader.comp:12", or
  // only the file when the declaration is not found.
  SourceLocation where_declared(const frontend::Binding& binding) const;
  SourceLocation where_declared(const std::string& word) const;
};

// Says what all shaders together bind at one place.
struct BindingUse {
  const ShaderModule* module = nullptr;  // the first module that has the binding
  frontend::Binding binding;
  bool is_used = false;  // the code of a shader uses it
};

class Modules {
 public:
  // Compiles every shader file of the description. Throws UserError that lists what is wrong with the
  // shaders' names and constants.
  Modules(const PipelineDescription& description, const CompilerParams& compiler, bool only_reflect = false);

  const std::vector<ShaderModule>& all() const { return modules_; }
  const ShaderModule& find(const std::string& name) const;
  uint32_t index_of(const std::string& name) const;
  const std::map<std::pair<uint32_t, uint32_t>, BindingUse>& bindings() const { return bindings_; }
  std::vector<std::string> warnings;

 private:
  void compile(const ShaderFile& file, const PipelineDescription& description, const CompilerParams& compiler,
               bool only_reflect);
  void merge(const ShaderModule& module, const frontend::Reflection& simplified, Diagnostics& errors);

  std::vector<ShaderModule> modules_;
  std::vector<frontend::Reflection> simplified_;
  std::map<std::pair<uint32_t, uint32_t>, BindingUse> bindings_;
  std::set<std::string> constants_met_;
};

const char* name_of(frontend::BindingKind kind);  // such as "storage buffer"

// Reads a module: GLSL by its ending, .spv, or .spvasm.
std::vector<uint32_t> read_module(const std::string& path, const frontend::GlslOptions& glsl);

}  // namespace glint::pipeline
