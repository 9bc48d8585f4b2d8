// Makes the parameters of a GPU from --config and --set.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/glint/options/resources.h"
#include "pipeline/params.h"

namespace glint::app {

// Reads the preset or file first, on top of the one that its key `base` names, then applies the settings in
// order, of which "oracle=NAME" stands for several (oracles.h). Throws UserError that lists everything that
// is wrong. Oddities of the resulting machine are warned of on stderr.
pipeline::GpuParams read_config(const Resources& resources, const std::string& name_or_path,
                                const std::vector<std::string>& settings);

// Reads a preset without warnings, to list it or to compare with it.
pipeline::GpuParams read_preset(const Resources& resources, const std::string& name_or_path,
                                const std::vector<std::string>& settings = {});

// Returns the names of the presets that stand without a base, sorted.
std::vector<std::string> names_of_whole_presets(const Resources& resources);

// Returns a hash of all keys and their values, which names a configuration in run.json.
uint64_t config_hash(const pipeline::GpuParams& params);

}  // namespace glint::app
