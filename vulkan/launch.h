// Runs a launch on the simulated GPU with what a command buffer has bound.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "vulkan/command_buffer.h"

namespace glint::vulkan {

// Runs `groups` blocks whose numbers begin at `base`. Says faults that were let pass, and what the shader
// prints. Throws Error when the shader cannot be compiled, or does something that ends the launch.
void launch(Queue& queue, const Bindings& bound, const std::array<uint32_t, 3>& base,
            const std::array<uint32_t, 3>& groups);

}  // namespace glint::vulkan
