// Compiles a script's shader to a program.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "amber/script.h"
#include "frontend/compile.h"
#include "frontend/spirv/reflection.h"
#include "pipeline/params.h"

namespace glint::amber {

struct CompiledShader {
  std::string name;
  isa::Program program;
  frontend::Reflection reflection;
};

// Returns SPIR-V words that are not yet validated. Throws UserError when the text is wrong.
std::vector<uint32_t> spirv_of(const Shader& shader, isa::Stage stage,
                               frontend::ShaderCache* cache = nullptr);

// Throws UserError and UnsupportedError in the same cases as frontend::lower().
CompiledShader compile(const Script& script, const Attachment& attachment,
                       const pipeline::CompilerParams& compiler, frontend::ShaderCache* cache = nullptr);

// Compiles every shader of a pipeline and of the libraries that it uses.
std::vector<CompiledShader> compile(const Script& script, const Pipeline& pipeline,
                                    const pipeline::CompilerParams& compiler,
                                    frontend::ShaderCache* cache = nullptr);

// Returns the groups of a pipeline and of its libraries, with their names.
std::vector<std::pair<std::string, std::vector<std::string>>> all_groups(const Script& script,
                                                                         const Pipeline& pipeline);

}  // namespace glint::amber
