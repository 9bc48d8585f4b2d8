// Runs the pass of SPIRV-Tools that clamps indices.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/clamped_indices.h"

#include <fmt/format.h>
#include <spirv-tools/optimizer.hpp>

#include "base/diagnostics.h"

namespace glint::frontend {

std::vector<uint32_t> with_clamped_indices(const std::vector<uint32_t>& words, const std::string& name) {
  std::string messages;
  spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
  optimizer.SetMessageConsumer(
      [&](spv_message_level_t level, const char*, const spv_position_t&, const char* text) {
        if (level <= SPV_MSG_ERROR) messages += fmt::format("\n{}", text);
      });
  optimizer.RegisterPass(spvtools::CreateGraphicsRobustAccessPass());
  spvtools::OptimizerOptions options;
  options.set_run_validator(false);
  std::vector<uint32_t> out;
  if (!optimizer.Run(words.data(), words.size(), &out, options))
    throw UnsupportedError(
        fmt::format("unsupported: the indices of shader '{}' cannot be clamped{}", name, messages));
  return out;
}

}  // namespace glint::frontend
