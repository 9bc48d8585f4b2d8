// Runs a launch of any kind on the machine that the user has chosen for it, and tells and records what it
// did.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string>

#include "exec/executor.h"
#include "exec/print_log.h"
#include "pipeline/capsule/capsule.h"
#include "vulkan/pipeline.h"
#include "vulkan/queue.h"

namespace glint::vulkan {

// Says what a launch is called in messages, in choices of GLINT_TIMING and in the index.
struct LaunchOf {
  std::string kind;              // "dispatch" or "trace"
  std::array<uint64_t, 3> size;  // blocks of a dispatch, rays of a trace
  VkPipeline_T& pipeline;        // is launched once more
  // Returns the launch with its memory, as it is before it runs.
  std::function<pipeline::Capsule()> save = {};
};

// Runs a world. Says faults that were let pass, and what the shader printed. Throws as
// pipeline::Device::run() does.
void run_launch(Queue& queue, const LaunchOf& launch, const exec::World& world, exec::PrintLog& prints);

}  // namespace glint::vulkan
