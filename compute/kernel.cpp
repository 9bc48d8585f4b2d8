// Hands buffers and constants to a GLSL kernel by descriptors and push constants, to a PTX kernel by
// parameters.
// SPDX-License-Identifier: Apache-2.0
#include "compute/kernel.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/check.h"
#include "base/regular_file.h"
#include "pipeline/kernel_launch.h"

namespace glint::compute {
namespace {

class GlslKernel : public Kernel {
 public:
  GlslKernel(pipeline::CompiledStage stage, const pipeline::GpuParams& gpu, frontend::ShaderCache* cache,
             std::shared_ptr<mem::AddressSpace> memory)
      : shaders_({stage.program}, stage.reflection.bindings, gpu, cache), memory_(std::move(memory)) {}

  void launch(const LaunchInputs& inputs, const std::function<void(exec::World& world)>& run) override {
    pipeline::LaunchBuilder builder(shaders_, *memory_);
    for (uint32_t i = 0; i < inputs.buffers.size(); ++i) builder.bind_buffers({0, i}, {inputs.buffers[i]});
    builder.set_push_constants(inputs.constants);
    builder.set_blocks(0, inputs.groups);
    run(builder.finish());
    for (const Address at : builder.allocations()) memory_->free(at);
  }

 private:
  pipeline::LinkedShaders shaders_;
  std::shared_ptr<mem::AddressSpace> memory_;
};

class PtxKernel : public Kernel {
 public:
  PtxKernel(frontend::Kernel kernel, const std::string& file, const pipeline::GpuParams& gpu,
            std::shared_ptr<mem::AddressSpace> memory)
      : kernel_(std::move(kernel), std::move(memory)) {
    if (!kernel_.kernel().required_block)
      throw UserError({file}, "the kernel does not say how many threads its blocks have",
                      "add '.reqntid X, Y, Z' behind its parameters");
    kernel_.world.layout = gpu.core.layout.make({});
  }

  void launch(const LaunchInputs& inputs, const std::function<void(exec::World& world)>& run) override {
    std::vector<std::vector<std::byte>> arguments;
    for (const pipeline::BufferRange& buffer : inputs.buffers)
      arguments.push_back(pipeline::KernelWorld::argument(buffer.address));
    std::span<const std::byte> rest = inputs.constants;
    const std::vector<frontend::KernelParameter>& parameters = kernel_.kernel().parameters;
    for (size_t i = arguments.size(); i < parameters.size(); ++i) {
      const std::span<const std::byte> value = rest.first(std::min<size_t>(rest.size(), parameters[i].bytes));
      arguments.emplace_back(value.begin(), value.end());
      rest = rest.subspan(value.size());
    }
    GLINT_CHECK(rest.empty(), "a kernel's parameters hold all constants");
    kernel_.set_grid({inputs.groups, *kernel_.kernel().required_block, 0});
    kernel_.set_arguments(arguments);
    run(kernel_.world);
  }

 private:
  pipeline::KernelWorld kernel_;
};

}  // namespace

std::unique_ptr<Kernel> compile_kernel(const std::string& stem, Form form, const pipeline::GpuParams& gpu,
                                       frontend::ShaderCache* cache,
                                       std::shared_ptr<mem::AddressSpace> memory) {
  if (form == Form::Ptx) {
    const std::string file = stem + ".ptx";
    const std::optional<std::string> text = read_regular_file(file);
    if (!text) throw UserError({file}, "the kernel cannot be read");
    const frontend::PtxOptions options = pipeline::ptx_options(gpu.compiler, gpu.compiler.contract);
    return std::make_unique<PtxKernel>(frontend::compile_ptx(*text, file, "", options), file, gpu,
                                       std::move(memory));
  }
  const std::string file = stem + ".comp";
  frontend::GlslOptions glsl;
  glsl.cache = cache;
  Diagnostics notes;
  pipeline::StageSource source{file, "", {}, frontend::Validity::Known};
  return std::make_unique<GlslKernel>(
      pipeline::compile_stage(frontend::spirv_of_file(file, glsl), source, gpu.compiler, notes, cache), gpu,
      cache, std::move(memory));
}

}  // namespace glint::compute
