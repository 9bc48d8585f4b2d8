// Runs a launch on the simulated GPU with what a command buffer has bound.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/launch.h"

#include "exec/print_log.h"
#include "pipeline/launch_builder.h"
#include "vulkan/bound_descriptors.h"
#include "vulkan/device.h"
#include "vulkan/pipeline.h"
#include "vulkan/run_launch.h"

namespace glint::vulkan {
namespace {

// Frees what the builder has allocated and, when they are many, parts of buffers, also when the launch ends
// with an exception.
class Allocations {
 public:
  Allocations(Device& device, const pipeline::LaunchBuilder& builder)
      : memory_(device.memory), parts_(device.parts), builder_(builder) {}
  ~Allocations() {
    for (const Address each : builder_.allocations()) memory_.free(each);
    parts_.trim(memory_);
  }
  Allocations(const Allocations&) = delete;
  Allocations& operator=(const Allocations&) = delete;

 private:
  mem::AddressSpace& memory_;
  BufferParts& parts_;
  const pipeline::LaunchBuilder& builder_;
};

}  // namespace

void launch(Queue& queue, const Bindings& bound, const std::array<uint32_t, 3>& base,
            const std::array<uint32_t, 3>& groups) {
  if (!groups[0] || !groups[1] || !groups[2]) return;
  Device& device = queue.device;
  const pipeline::LinkedShaders& shaders = bound.pipeline->compiled(device);
  pipeline::LaunchBuilder builder(shaders, device.memory);
  const Allocations allocations(device, builder);
  for (const auto& [place, use] : shaders.declared()) bind(device, builder, bound, use);
  builder.set_push_constants(bound.push_constants);
  builder.set_blocks(0, groups, {bound.pipeline->name, 0, 0});
  exec::set_first_block(builder.world, base);
  exec::PrintLog prints;
  builder.world.prints = &prints;
  builder.world.robust_buffers = device.has("robustBufferAccess");
  builder.world.robust_images = device.has("robustImageAccess");
  builder.world.on_fault = device.physical.instance.settings.on_fault;
  const uint32_t need = device.physical.gpu.rt.unit == rt::kSoftware ? stack_need(device) : 0;
  run_launch(queue, {"dispatch", {groups[0], groups[1], groups[2]}, *bound.pipeline}, builder.finish(need),
             prints);
}

}  // namespace glint::vulkan
