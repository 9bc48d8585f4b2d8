// Runs a launch on the simulated GPU with what a command buffer has bound.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "pipeline/device_table.h"
#include "vulkan/command_buffer.h"

namespace glint::vulkan {

// Runs `groups` blocks whose numbers begin at `base`. Says faults that were let pass, and what the shader
// prints. Throws Error when the shader cannot be compiled, or does something that ends the launch.
void launch(Queue& queue, const Bindings& bound, const std::array<uint32_t, 3>& base,
            const std::array<uint32_t, 3>& groups);

// Runs a launch of rays with the records that the table names. A table without a ray generation group of the
// pipeline is said, and nothing runs, unless faults lose the device.
void launch_rays(Queue& queue, const Bindings& bound, pipeline::DeviceTable table,
                 const std::array<uint32_t, 3>& size);

}  // namespace glint::vulkan
