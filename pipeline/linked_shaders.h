// Compiles the shaders that a host hands over as modules, and links those of a pipeline for its launches.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "exec/image.h"
#include "frontend/compile.h"
#include "frontend/spirv/reflection.h"
#include "pipeline/params.h"
#include "pipeline/unbound.h"

namespace glint::pipeline {

frontend::BackendOptions backend_options(const CompilerParams& compiler);

// Describes a stage of a pipeline as a host gives it (VkPipelineShaderStageCreateInfo), next to its module.
struct StageSource {
  std::string name;                                           // names the module in messages
  std::string entry;                                          // entry point; empty: the module's only one
  std::map<uint32_t, uint64_t> specialization;                // bits of constants by constant_id
  frontend::Validity validity = frontend::Validity::Unknown;  // of the words as they are given
};

struct CompiledStage {
  frontend::Reflection reflection;  // what the module declares, whether its code uses it or not
  std::vector<uint32_t> simplified;
  isa::Program program;
};

// Compiles one entry point of a module. Throws UserError for words that are no valid module, and
// UnsupportedError for what the shader uses and Glint lacks.
CompiledStage compile_stage(std::vector<uint32_t> words, const StageSource& source,
                            const CompilerParams& compiler, Diagnostics& notes, frontend::ShaderCache* cache);

// Holds the code of a pipeline and what its shaders declare. It is made once and serves any number of
// launches, which it must outlive.
class LinkedShaders {
 public:
  // Numbers the shaders in the order of `programs`. `declared` are the bindings of all of them together, in
  // any order. Throws UserError when `gpu` has no RT unit and the shaders ask for what only that can do.
  LinkedShaders(std::vector<isa::Program> programs, const std::vector<frontend::Binding>& declared,
                const GpuParams& gpu, frontend::ShaderCache* cache);
  LinkedShaders(const LinkedShaders&) = delete;
  LinkedShaders& operator=(const LinkedShaders&) = delete;

  const exec::Image& image() const { return image_; }
  const std::map<BindingPlace, frontend::Binding>& declared() const { return declared_; }
  // Returns what the shaders declare at a place, or null. Where they disagree, it is the first declaration
  // with the most elements of any.
  const frontend::Binding* declared_at(BindingPlace place) const;

  // Sets what every world of these shaders has: its code, and how the GPU lays out warps and treats rays.
  void give_to(exec::World& world) const;

 private:
  exec::Image image_;
  std::map<BindingPlace, frontend::Binding> declared_;
  std::shared_ptr<const rt::AnyHitMode> any_hit_;
  std::shared_ptr<const exec::WarpLayout> layout_;
  bool nearest_first_hit_;
};

}  // namespace glint::pipeline
