// Holds command buffers: lists of what to do, and what is bound while they are recorded.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "vulkan/descriptor_buffer.h"
#include "vulkan/descriptor_set.h"
#include "vulkan/instance.h"
#include "vulkan/queue.h"
#include "vulkan/render_pass.h"

namespace glint::vulkan {

// Is a set as a launch finds it. What is written to the set before the launch runs counts.
struct BoundSet {
  DescriptorSet* set = nullptr;
  std::shared_ptr<DescriptorSet> pushed;              // owns `set` when it was pushed
  std::vector<uint32_t> dynamic_offsets;              // in the order of the layout's dynamic descriptors
  std::shared_ptr<const StoredSet> stored = nullptr;  // instead of `set` where descriptors lie in memory
};

// Is all that a launch takes from the commands before it.
struct Bindings {
  VkPipeline pipeline = nullptr;
  std::map<uint32_t, BoundSet> sets;  // by number
  std::array<std::byte, kMaxPushConstantBytes> push_constants{};
  std::optional<uint32_t> stack_bytes;  // of a ray-tracing pipeline whose stack has a dynamic size
};

}  // namespace glint::vulkan

struct VkCommandBuffer_T : glint::vulkan::Dispatchable {
  enum class State : uint8_t { Initial, Recording, Executable };

  VkCommandBuffer_T(VkDevice_T& of, VkCommandPool from) : device(of), pool(from) {}
  // Adds a command that never waits: `run(queue)`.
  template <class Run>
  void record(Run run) {
    record_waiting([run = std::move(run)](VkQueue_T& queue) {
      run(queue);
      return true;
    });
  }
  // Adds a command that says whether it is done.
  void record_waiting(glint::vulkan::Command command) {
    commands.push_back(std::make_shared<const glint::vulkan::Command>(std::move(command)));
  }
  void reset();
  // Appends all commands of this buffer to a list. Throws Refusal when it was not recorded to its end.
  void append_to(glint::vulkan::CommandList& list) const;

  VkDevice_T& device;
  VkCommandPool pool;
  State state = State::Initial;
  VkResult failure = VK_SUCCESS;  // of the first command that could not be recorded
  glint::vulkan::CommandList commands;
  // What is bound for dispatches, and what is bound for rays. Push constants are written to both.
  glint::vulkan::Bindings bound, bound_for_rays;
  std::vector<glint::Address> descriptor_buffers;  // that are bound
  std::string graphics_pipeline;                   // the name of the one that is bound
  glint::vulkan::Rendering rendering;
};

struct VkCommandPool_T {
  std::set<VkCommandBuffer> buffers;
};
