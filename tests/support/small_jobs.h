// Makes frames that are small enough to run in a test.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "pipeline/render.h"
#include "tests/support/kept_shaders.h"
#include "tests/support/preset.h"

namespace glint::test {

inline const char* shader_folder(pipeline::Workload workload) {
  switch (workload) {
    case pipeline::Workload::PathTracing:
      return "path_tracing";
    case pipeline::Workload::Shadow:
      return "shadow";
    case pipeline::Workload::AmbientOcclusion:
      return "ambient_occlusion";
  }
  return "";
}

// Returns `size` x `size` pixels of a built-in scene on a small GPU of two cores. A program compiles each of
// its shaders once for all its jobs.
inline pipeline::RenderJob small_job(const std::string& scene, pipeline::Workload workload, uint32_t size,
                                     uint32_t samples, const std::string& assets = {}) {
  pipeline::RenderJob job;
  job.glsl.cache = kept_shaders();
  job.scene = scenes::load_scene(scene, {assets});
  job.workload = workload;
  job.frame.width = job.frame.height = size;
  job.frame.samples = samples;
  job.gpu.cores = 2;
  job.shader_dir = std::string(GLINT_SOURCE_DIR) + "/shaders/" + shader_folder(workload);
  return job;
}

}  // namespace glint::test
