// Puts a scene into simulated memory as the shaders' descriptor set 0, with its pipeline and binding table.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "pipeline/opacity_bake.h"
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

// Returns how the shaders of a workload are compiled: the job's options, with what its scene defines.
frontend::GlslOptions workload_options(const RenderJob& job);

// Names the bindings of set 0 (shaders/README.md).
enum SceneBinding : uint32_t {
  kTopLevel,
  kAccumulationImage,
  kPictureImage,
  kFrame,
  kVertices,
  kIndices,
  kMaterials,
  kOffsets,
  kTextures,
  kSpheres
};
inline constexpr uint32_t kSphereRecord = 1;  // hit record of procedural models; triangles have record 0

// Returns the box of a procedural model.
rt::Bounds sphere_bounds(const scenes::Model& model);

// Holds memory, images and records of one launch. It cannot be moved, because `world` points into it.
class SceneWorld {
 public:
  // Names a job's own scene, whose models and textures lose their contents once these are uploaded.
  struct Drain {
    scenes::Scene& scene;
  };
  explicit SceneWorld(const RenderJob& job) : SceneWorld(job, nullptr) {}
  SceneWorld(const RenderJob& job, const Drain& drain) : SceneWorld(job, &drain.scene) {}
  SceneWorld(const SceneWorld&) = delete;
  SceneWorld& operator=(const SceneWorld&) = delete;

  exec::World world;
  std::vector<std::string> warnings;  // warnings of the compiler
  StructureCounts structures;
  mem::AddressSpace& memory() { return memory_; }
  std::vector<float> read_image(uint32_t handle) const;       // 4 floats per texel of the launch
  static constexpr uint32_t kAccumulation = 0, kPicture = 1;  // image handles

 private:
  // Holds what was uploaded of a model. It is read there once the model itself may be empty.
  struct Uploaded {
    std::span<const scenes::Vertex> vertices;
    std::span<const uint32_t> indices;
  };

  SceneWorld(const RenderJob& job, scenes::Scene* drain);
  void upload_geometry(const RenderJob& job, scenes::Scene* drain);
  rt::EncodedStructure encode_bottom(const RenderJob& job, size_t model, uint32_t threads) const;
  rt::Micromaps bake(const RenderJob& job, size_t model, const rt::MicromapFormat& format) const;
  void upload_images(const RenderJob& job, scenes::Scene* drain);
  std::vector<rt::StructureInfo> build_bottoms(const RenderJob& job);
  void build_structures(const RenderJob& job);
  void link_shaders(const RenderJob& job);
  void bind(uint32_t binding, uint64_t address_or_handle, uint64_t bytes_or_count);
  template <class Value>
  std::span<Value> bind_new(uint32_t binding, const char* name, uint64_t count);  // a buffer of zeros
  Address upload(const std::string& name, const void* data, uint64_t bytes);

  mem::AddressSpace memory_;
  std::vector<Uploaded> uploaded_;   // of each model
  std::vector<AlphaTexture> alpha_;  // the scene's textures, as they were uploaded
  std::set<uint32_t> bound_;         // bindings of set 0
  exec::Image image_;
};

}  // namespace glint::pipeline
