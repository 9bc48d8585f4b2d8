// Puts a scene into simulated memory as the shaders' descriptor set 0, with its pipeline and binding table.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "pipeline/render.h"
#include "pipeline/unbound.h"
#include "rtunit/structure/build.h"

namespace glint::pipeline {

// Holds the compiled shaders of a built-in workload: the files of job.shader_dir with their fixed names.
struct WorkloadShaders {
  std::vector<isa::Program> programs;
  uint32_t raygen = 0, miss = 0;
  exec::HitGroup triangle, sphere;
  Diagnostics warnings;
};
WorkloadShaders compile_workload(const RenderJob& job);

// Holds memory, images and records of one launch. It cannot be moved, because `world` points into it.
class SceneWorld {
 public:
  explicit SceneWorld(const RenderJob& job);
  SceneWorld(const SceneWorld&) = delete;
  SceneWorld& operator=(const SceneWorld&) = delete;

  exec::World world;
  std::vector<std::string> warnings;  // warnings of the compiler
  StructureCounts structures;
  mem::AddressSpace& memory() { return memory_; }
  std::vector<float> read_image(uint32_t handle) const;       // 4 floats per texel of the launch
  static constexpr uint32_t kAccumulation = 0, kPicture = 1;  // image handles

 private:
  void upload_geometry(const scenes::Scene& scene);
  void upload_images(const RenderJob& job);
  std::vector<rt::StructureInfo> build_bottoms(const RenderJob& job);
  void build_structures(const RenderJob& job);
  void link_shaders(const RenderJob& job);
  void bind(uint32_t binding, uint64_t address_or_handle, uint64_t bytes_or_count);
  Address upload(const std::string& name, const void* data, uint64_t bytes);

  mem::AddressSpace memory_;
  std::set<uint32_t> bound_;  // bindings of set 0
  exec::Image image_;
};

}  // namespace glint::pipeline
