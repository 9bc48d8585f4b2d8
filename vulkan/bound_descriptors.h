// Gives a launch the descriptors that its shader uses, as they are when it runs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/spirv/reflection.h"
#include "pipeline/launch_builder.h"
#include "vulkan/command_buffer.h"

namespace glint::vulkan {

// Binds what `bound` has at the place that a shader declares. Where nothing is bound, its use is a fault.
// Throws Refusal when a descriptor names a buffer without memory, or a range that leaves its buffer.
void bind(Device& device, pipeline::LaunchBuilder& builder, const Bindings& bound,
          const frontend::Binding& use);

}  // namespace glint::vulkan
