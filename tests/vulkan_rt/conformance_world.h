// Puts the recorded scene into simulated memory, with its two pipelines: records of rays, and the picture.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/binding_table.h"
#include "tests/vulkan_rt/recording.h"

namespace glint::vulkan_rt {

struct RecordData {  // struct SbtData of shaders/common.glsl
  uint32_t tag, base, alpha, pad;
  std::array<float, 4> color;
};

// Returns what the recording does not hold: the data of the hit records (see README.md).
const std::vector<RecordData>& hit_records();

// Compiles the set's unchanged shaders and runs a mode with structures of a node format. Returns one record
// per ray. With `software`, rays are walked in code.
std::vector<Record> run_mode(const Recording& recording, const Mode& mode, const std::string& any_hit,
                             bool timing = false, const std::string& format = "bvh6", bool software = false);

// Returns the picture, RGBA, `size` x `size`. The records' data may be given.
std::vector<float> run_image(const Recording& recording, uint32_t size,
                             const std::vector<RecordData>& records = hit_records());

}  // namespace glint::vulkan_rt
