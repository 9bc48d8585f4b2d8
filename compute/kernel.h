// Compiles the kernels of a compute program in either of their forms, GLSL or PTX, and prepares their
// launches.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "compute/program.h"
#include "pipeline/launch_builder.h"
#include "pipeline/params.h"

namespace glint::compute {

// Is what a host gives to a launch, in whichever form the kernel is.
struct LaunchInputs {
  std::array<uint32_t, 3> groups{};
  const std::vector<pipeline::BufferRange>& buffers;
  std::span<const std::byte> constants;
};

class Kernel {
 public:
  virtual ~Kernel() = default;
  // Calls `run` with the world of a launch, which ends with the call.
  virtual void launch(const LaunchInputs& inputs, const std::function<void(exec::World& world)>& run) = 0;
};

// Compiles STEM.comp or STEM.ptx. A kernel in GLSL has its buffers at binding 0 and following of set 0, and
// its constants as push constants. One in PTX has the address of each buffer and then each constant as
// parameters, and says with .reqntid how large its blocks are. Throws UserError where a file or its kernel is
// not like that.
std::unique_ptr<Kernel> compile_kernel(const std::string& stem, Form form, const pipeline::GpuParams& gpu,
                                       frontend::ShaderCache* cache,
                                       std::shared_ptr<mem::AddressSpace> memory);

}  // namespace glint::compute
