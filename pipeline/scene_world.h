// Puts a scene into simulated memory as the shaders' descriptor set 0, with its pipeline and binding table.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
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
inline constexpr const char* kTopName = "top level";
inline constexpr uint32_t kSphereRecord = 1;  // hit record of procedural models; triangles have record 0

// Returns the box of a procedural model.
rt::Bounds sphere_bounds(const scenes::Model& model);

// Returns the name of a model's structure in messages.
inline std::string name_of_model(const scenes::Model& model) {
  return "bottom level " + model.name;
}

// Returns what binding 9 holds of a model: centre and radius, or zeros for triangles.
inline scenes::Vec4 sphere_of(const scenes::Model& model) {
  return model.is_procedural() ? scenes::Vec4(model.center, model.radius) : scenes::Vec4(0);
}

// Says what a frame did to the structures, and how good they are.
struct StructureWork {
  struct Levels {
    uint64_t built = 0, refitted = 0, kept = 0;  // `kept` ones are as they were
  } bottom, top;
  std::vector<std::string> notes;  // why levels were built that should have been fitted, as sentences
  // The nodes and leaves that a ray is expected to visit (rt::expected_visits()) in all levels: those that
  // the frame has, and those that it would have if all of them had been built for it.
  double expected_visits = 0, expected_visits_rebuilt = 0;
};

// Holds memory, images and records of one launch. It cannot be moved, because `world` points into it.
class SceneWorld {
 public:
  // Names a job's own scene, whose models and textures lose their contents once these are uploaded.
  struct Drain {
    scenes::Scene& scene;
  };
  explicit SceneWorld(const RenderJob& job) : SceneWorld(job, nullptr) {}
  SceneWorld(const RenderJob& job, const Drain& drain) : SceneWorld(job, &drain.scene) {}
  ~SceneWorld();
  SceneWorld(const SceneWorld&) = delete;
  SceneWorld& operator=(const SceneWorld&) = delete;

  exec::World world;
  std::vector<std::string> warnings;  // warnings of the compiler
  StructureCounts structures;
  mem::AddressSpace& memory() { return memory_; }
  std::vector<float> read_image(uint32_t handle) const;  // 4 floats per texel of the launch
  // Prepares the next frame of a scene that moves: takes the scene's vertices, spheres, instances and camera,
  // which are all that its motion changes, updates the structures as the job says, and clears the images. The
  // world is then as if the scene had been loaded so, but for the places of structures in memory, and for how
  // they were updated. The job is the one that the world was made of. Throws UserError as building structures
  // does.
  StructureWork advance(const RenderJob& job);
  // Returns what advance() would return for the first frame, for which everything was built.
  StructureWork first_work(const RenderJob& job);
  static constexpr uint32_t kAccumulation = 0, kPicture = 1;  // image handles

 private:
  struct Moving;  // scene_frames.cpp; what is kept to update the structures

  // Holds what was uploaded of a model. It is read there once the model itself may be empty.
  struct Uploaded {
    std::span<scenes::Vertex> vertices;
    std::span<const uint32_t> indices;
  };

  SceneWorld(const RenderJob& job, scenes::Scene* drain);
  void upload_geometry(const RenderJob& job, scenes::Scene* drain);
  // Holds the input of a model's bottom level. It stays where it is, because `level` points into it.
  struct BottomInput {
    rt::Bounds box;
    rt::BottomLevel level;
  };
  void describe_bottom(const RenderJob& job, size_t model, BottomInput& out) const;
  rt::EncodedStructure encode_bottom(const RenderJob& job, size_t model, uint32_t threads,
                                     rt::KeptTree* kept) const;
  rt::Micromaps bake(const RenderJob& job, size_t model, const rt::MicromapFormat& format) const;
  void upload_images(const RenderJob& job, scenes::Scene* drain);
  void build_bottoms(const RenderJob& job);
  static std::vector<rt::Instance> place_instances(const RenderJob& job);
  void build_structures(const RenderJob& job);
  void bind_top();
  // These are in scene_frames.cpp.
  bool deforms(size_t model) const;
  rt::KeptTree* kept_tree(size_t model);
  rt::EncodedStructure encode_top(const RenderJob& job, std::span<const rt::Instance> instances);
  void move_vertices(const RenderJob& job);
  void update_bottom(const RenderJob& job, size_t model, StructureWork& work);
  void update_top(const RenderJob& job, StructureWork& work);
  uint64_t room_of_bottom(const RenderJob& job, size_t model) const;
  rt::StructureInfo place(const std::string& name, rt::EncodedStructure structure, uint64_t room);
  void replace(rt::StructureInfo& info, const std::string& name, rt::EncodedStructure structure);
  void measure(const RenderJob& job, StructureWork& work);
  void link_shaders(const RenderJob& job);
  void bind(uint32_t binding, uint64_t address_or_handle, uint64_t bytes_or_count);
  template <class Value>
  std::span<Value> bind_new(uint32_t binding, const char* name, uint64_t count);  // a buffer of zeros
  // Make contents of a packed scene a part of simulated memory, as they are.
  Address adopt(std::string name, const scenes::PackedContents& packed, std::span<std::byte> bytes);
  template <class Value>
  std::span<Value> bind_packed(uint32_t binding, const char* name, const scenes::PackedContents& packed,
                               std::span<Value> values);
  Address upload(const std::string& name, const void* data, uint64_t bytes);

  mem::AddressSpace memory_;
  std::vector<Uploaded> uploaded_;          // of each model
  std::vector<AlphaTexture> alpha_;         // the scene's textures, as they were uploaded
  std::vector<rt::StructureInfo> bottoms_;  // of each model
  rt::StructureInfo top_;
  std::span<scenes::Vec4> spheres_;  // binding 9
  Address frame_ = 0;                // binding 3
  uint32_t local_bytes_ = 0;         // World::local_bytes without what place_records() adds
  std::unique_ptr<Moving> moving_;   // null where nothing moves
  std::set<uint32_t> bound_;         // bindings of set 0
  exec::Image image_;
};

// Adds the pictures that a launch of the scene has left, and what is known of the scene, to its result.
void read_frame(const SceneWorld& scene, const RenderJob& job, RenderResult& result);

}  // namespace glint::pipeline
