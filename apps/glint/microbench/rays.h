// Measures ray tracing: latencies of hits, rates of rays and tests, divergence. The same rays can be written
// as frames for other GPUs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/glint/microbench/kernel.h"

namespace glint::app {

// Returns the benchmarks of the group "rays". `shader_dir` is the folder of the shaders ray_probes.
std::vector<MicroBench> ray_benchmarks(const std::string& shader_dir);

// Writes each launch of these benchmarks as a frame (docs/frames.md) below `folder`, and probes.json, which
// says what is computed from their times. Every launch has as many threads as a machine of `cores` cores
// gets.
void write_ray_frames(const std::string& shader_dir, const std::string& folder, uint32_t cores);

}  // namespace glint::app
