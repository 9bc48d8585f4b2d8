// Lets applications look into a pipeline: what its shaders need of a core, and their code.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <string>
#include <string_view>
#include <vector>

#include "core/residency.h"
#include "isa/text.h"
#include "vulkan/chain.h"
#include "vulkan/command_buffer.h"
#include "vulkan/device.h"
#include "vulkan/pipeline.h"

namespace glint::vulkan {
namespace {

// Copies a text with its end, as far as there is room.
template <size_t N>
void put_text(char (&to)[N], std::string_view text) {
  const size_t size = std::min(text.size(), N - 1);
  std::memcpy(to, text.data(), size);
  to[size] = 0;
}

const std::vector<isa::Program>& programs_of(Device& device, VkPipeline pipeline) {
  return pipeline->compiled(device).image().programs;
}

const isa::Program& program_of(Device& device, const VkPipelineExecutableInfoKHR& info) {
  const auto& all = programs_of(device, info.pipeline);
  if (info.executableIndex >= all.size())
    throw Refusal(
        fmt::format("the pipeline has {} executables, and no number {}", all.size(), info.executableIndex));
  return all[info.executableIndex];
}

struct Statistic {
  const char *name, *description;
  uint64_t value;
};

std::vector<Statistic> statistics_of(const Device& device, const isa::Program& program) {
  uint64_t on_stack = 0;
  for (const isa::Inst& inst : program.code) {
    const std::string text = isa::to_text(program, inst);
    on_stack += text.find("ld.local") != std::string::npos || text.find("st.local") != std::string::npos;
  }
  core::LaunchNeeds needs{.registers = program.num_registers, .shared_bytes = program.shared_bytes};
  if (program.stage == isa::Stage::Compute) {
    const auto& [x, y, z] = program.local_size;
    needs.warps = (x * y * z + uint32_t(kLanes) - 1) / uint32_t(kLanes), needs.has_blocks = true;
  }
  const core::Residency fits = core::residency(device.physical.gpu.core, needs);
  return {
      {"Registers", "Registers of 32 bits that each thread holds.", program.num_registers},
      {"Instructions", "Instructions of the code.", program.code.size()},
      {"Stack bytes", "Bytes of the stack that each thread has for variables, spilled and saved registers.",
       program.local_bytes},
      {"Stack instructions", "Instructions that load from the stack or store to it, as spilled registers do.",
       on_stack},
      {"Shared bytes", "Bytes of shared memory that each workgroup has.", program.shared_bytes},
      {"Resident warps", "Warps that fit on a core at a time.", fits.warps},
      {"Resident workgroups", "Workgroups that fit on a core at a time.", fits.blocks}};
}

}  // namespace

VkResult GetPipelineExecutablePropertiesKHR(Device& device, const VkPipelineInfoKHR* info, uint32_t* count,
                                            VkPipelineExecutablePropertiesKHR* out) {
  const auto& all = programs_of(device, info->pipeline);
  return enumerate(uint32_t(all.size()), count, out, [&](auto& to, uint32_t i) {
    to.stages = flag_of(all[i].stage), to.subgroupSize = kLanes;
    put_text(to.name, all[i].name);
    put_text(to.description,
             fmt::format("{} shader of {}", isa::name_of(all[i].stage), info->pipeline->name));
  });
}

VkResult GetPipelineExecutableStatisticsKHR(Device& device, const VkPipelineExecutableInfoKHR* info,
                                            uint32_t* count, VkPipelineExecutableStatisticKHR* out) {
  const std::vector<Statistic> all = statistics_of(device, program_of(device, *info));
  return enumerate(uint32_t(all.size()), count, out, [&](auto& to, uint32_t i) {
    put_text(to.name, all[i].name);
    put_text(to.description, all[i].description);
    to.format = VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR, to.value.u64 = all[i].value;
  });
}

// There is one representation, the text of Glint's instructions, which `glint asm` reads.
VkResult GetPipelineExecutableInternalRepresentationsKHR(Device& device,
                                                         const VkPipelineExecutableInfoKHR* info,
                                                         uint32_t* count,
                                                         VkPipelineExecutableInternalRepresentationKHR* out) {
  const std::string text = isa::to_text(program_of(device, *info));
  bool is_whole = true;
  const VkResult result = enumerate(1, count, out, [&](auto& to, uint32_t) {
    put_text(to.name, "Glint ISA");
    put_text(to.description, "The instructions that the cores execute.");
    to.isText = VK_TRUE;
    const size_t bytes = text.size() + 1;
    if (to.pData) {
      is_whole = to.dataSize >= bytes;
      const size_t room = std::min(to.dataSize, bytes);
      std::memcpy(to.pData, text.c_str(), room);
      if (room) static_cast<char*>(to.pData)[room - 1] = 0;
      to.dataSize = room;
    } else {
      to.dataSize = bytes;
    }
  });
  return is_whole ? result : VK_INCOMPLETE;
}

}  // namespace glint::vulkan
