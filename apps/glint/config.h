// From --config and --set to the parameters of a GPU.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "apps/glint/resources.h"
#include "pipeline/params.h"

namespace glint::app {

// Preset or file first, then the settings in order. UserError lists everything that is wrong.
pipeline::GpuParams read_config(const Resources& resources, const std::string& name_or_path,
                                const std::vector<std::string>& settings);

}  // namespace glint::app
