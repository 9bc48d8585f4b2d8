// From --config and --set to the parameters of a GPU.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/glint/options/resources.h"
#include "pipeline/params.h"

namespace glint::app {

// Preset or file first, then the settings in order. UserError lists everything that is wrong; what is odd
// about the machine that comes of it is said on stderr.
pipeline::GpuParams read_config(const Resources& resources, const std::string& name_or_path,
                                const std::vector<std::string>& settings);

// A preset as it stands, to be listed or compared with: nothing is said about it.
pipeline::GpuParams read_preset(const Resources& resources, const std::string& name_or_path);

// Of all keys and their values: names a configuration in run.json.
uint64_t config_hash(const pipeline::GpuParams& params);

}  // namespace glint::app
