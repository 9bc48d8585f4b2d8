// Runs a launch on the simulated GPU with what a command buffer has bound.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/launch.h"

#include <fmt/format.h>
#include <string>
#include <vector>

#include "exec/print_log.h"
#include "pipeline/launch_builder.h"
#include "pipeline/render.h"
#include "vulkan/bound_descriptors.h"
#include "vulkan/device.h"
#include "vulkan/pipeline.h"

namespace glint::vulkan {
namespace {

// Says what the shader printed, and the faults that were let pass.
void say_results(const Queue& queue, const std::string& pipeline, const exec::FaultLog& faults,
                 exec::PrintLog& prints) {
  const Messages& messages = queue.device.messages();
  if (const std::string text = prints.take(); !text.empty()) messages.info(text);
  if (faults.empty()) return;
  const std::string label = queue.labels.empty() ? "" : fmt::format(", label '{}'", queue.labels.back());
  messages.warning(fmt::format("launch of {}{}:\n{}", pipeline, label, faults.to_string()));
}

// Runs a world on the machine that the user has chosen for this launch.
void run(Queue& queue, VkPipeline_T& pipeline, const exec::World& world, exec::PrintLog& prints) {
  Device& device = queue.device;
  const Settings& settings = device.physical.instance.settings;
  const LaunchFacts facts{device.launches.all++, pipeline.launches++, pipeline.name, queue.labels};
  pipeline::LaunchMode mode;
  mode.timing = settings.timing.takes(facts), mode.threads = settings.threads;
  const pipeline::RenderResult result = device.gpu.run(world, mode, {});
  if (mode.timing) {
    device.clock.add_timed_launch(result.cycles);
    ++device.launches.timed, device.launches.cycles += result.cycles;
    device.messages().info(
        fmt::format("dispatch {}: {}, {} cycles", facts.number, pipeline.name, result.cycles));
  } else {
    device.clock.add_launch(result.warp_instructions);
  }
  say_results(queue, pipeline.name, result.faults, prints);
}

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
  run(queue, *bound.pipeline, builder.finish(need), prints);
}

}  // namespace glint::vulkan
