// Holds a device: its memory, its queues, and what the application asked for when it made it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "frontend/cache.h"
#include "memsys/address_space.h"
#include "pipeline/device.h"
#include "vulkan/acceleration_structure.h"
#include "vulkan/clock.h"
#include "vulkan/instance.h"
#include "vulkan/memory.h"
#include "vulkan/process.h"
#include "vulkan/queue.h"
#include "vulkan/recording.h"

struct VkDevice_T : glint::vulkan::Dispatchable {
  // `machine` is the physical device's, with what the application's features add to it.
  VkDevice_T(VkPhysicalDevice_T& of, const glint::pipeline::GpuParams& machine)
      : physical(of),
        params(machine),
        clock(params),
        recording(of.instance.settings, params, of.instance.messages, clock),
        gpu(params) {
    const size_t families = glint::vulkan::queue_families(of.instance.settings.is_universal).size();
    for (size_t i = 0; i < families * glint::vulkan::kQueues; ++i) queues.emplace_back(*this);
  }
  ~VkDevice_T() { glint::vulkan::used_by_process() -= allocated_bytes; }
  VkDevice_T(const VkDevice_T&) = delete;
  VkDevice_T& operator=(const VkDevice_T&) = delete;

  // Runs what was submitted as far as it comes, and wakes the threads that wait for the device. Every call
  // that may free a queue or such a thread calls it.
  void advance();

  glint::vulkan::Messages& messages() const { return physical.instance.messages; }
  // Returns whether the application asked for a feature by its Vulkan name.
  bool has(std::string_view feature) const { return features.count(feature) != 0; }

  VkPhysicalDevice_T& physical;
  const glint::pipeline::GpuParams params;
  std::mutex mutex;  // A command that is given this device, or one of its queues, holds it (guard.h).
  std::condition_variable_any changed;  // Something that the host may wait for has changed.
  std::set<std::string_view> features;
  std::set<std::string, std::less<>> extensions;  // that the application enabled
  glint::mem::AddressSpace memory;
  glint::vulkan::BufferParts parts;               // of `memory`
  glint::frontend::ShaderCache shader_cache{{}};  // in memory only
  VkDeviceSize allocated_bytes = 0;               // of the heap
  std::set<VkAccelerationStructureKHR> structures;
  // The buffers, views and samplers that exist. Descriptors that no shader uses may name destroyed ones.
  std::unordered_set<const void*> bindable;
  std::vector<VkAccelerationStructureKHR> unplaced_structures;  // Their buffers have no memory yet.
  // They give objects names.
  uint32_t buffers_made = 0, images_made = 0, shaders_made = 0, structures_made = 0, micromaps_made = 0,
           ray_pipelines_made = 0, graphics_pipelines_made = 0;
  glint::vulkan::DeviceClock clock;
  glint::vulkan::Recording recording;
  glint::pipeline::Device gpu;  // runs launches
  struct Launches {
    uint64_t all = 0, timed = 0;
    glint::Cycle cycles = 0;  // of those that were timed
  } launches;
  uint64_t compute_threads = 0;  // that were launched
  uint64_t frames = 0;           // that were presented
  uint64_t builds = 0;           // of acceleration structures
  bool is_lost = false;          // A launch did something that ends the device.
  std::deque<VkQueue_T> queues;  // of the first family, then of the next one
};
