// Makes the parameters of a GPU from a preset and settings.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/params.h"
#include "setup/resources.h"

namespace glint::setup {

// Reads the preset or file first, on top of the one that its key `base` names, then applies the settings in
// order, of which "oracle=NAME" stands for several (oracles.h). Throws UserError that lists everything that
// is wrong.
pipeline::GpuParams read_preset(const Resources& resources, const std::string& name_or_path,
                                const std::vector<std::string>& settings = {});

// Returns what is odd about a machine that is possible, a sentence each.
std::vector<std::string> oddities_of(const pipeline::GpuParams& params);

// Returns the names of the presets that stand without a base, sorted.
std::vector<std::string> names_of_whole_presets(const Resources& resources);

// Returns a hash of all keys and their values, which names a configuration in run.json.
uint64_t config_hash(const pipeline::GpuParams& params);

}  // namespace glint::setup
