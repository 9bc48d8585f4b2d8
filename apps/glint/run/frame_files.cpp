// Writes the files of a frame.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/frame_files.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "frontend/compile.h"
#include "pipeline/scene_world.h"
#include "report/files/run_directory.h"
#include "scenes/camera.h"

namespace glint::app {
namespace {

using Json = nlohmann::ordered_json;
using scenes::Model;

// Has the layout of VkAccelerationStructureInstanceKHR, but names a bottom level by its number.
struct InstanceRecord {
  std::array<float, 12> transform{};
  uint32_t index_and_mask = 0;    // 24 bits, 8 bits
  uint32_t offset_and_flags = 0;  // 24 bits, 8 bits
  uint64_t bottom = 0;
};
static_assert(sizeof(InstanceRecord) == 64);
constexpr uint32_t kFacingCullDisable = 1;  // VkGeometryInstanceFlagBitsKHR
constexpr uint32_t kAllRays = 0xff;         // mask of an instance
constexpr const char *kOpaque = "opaque", *kNoDuplicates = "no_duplicate_any_hit";  // flags of geometry

class FrameWriter {
 public:
  FrameWriter(const pipeline::RenderJob& job, const std::string& folder) : job_(job), folder_(folder) {}

  FrameFiles write(const std::string& name) {
    const scenes::RenderParams& frame = job_.frame;
    frame_ = {{"format", "glint-frame"},
              {"version", kFrameVersion},
              {"name", name},
              {"launch", {frame.width, frame.height, 1}}};
    write_shaders();
    write_geometry();
    write_instances();
    write_bindings();
    frame_["picture"] = pipeline::kPictureImage;
    write_file("frame.json", frame_.dump(1) + "\n");
    return written_;
  }

 private:
  void write_file(const std::string& name, const std::string& bytes) {
    report::write_file((std::filesystem::path(folder_) / name).string(), bytes);
    ++written_.files;
    written_.bytes += bytes.size();
  }

  // Adds a buffer of at least 4 bytes, because no descriptor may be empty.
  void write_buffer(const std::string& name, std::string bytes) {
    bytes.resize(std::max<size_t>(bytes.size(), 4));
    frame_["buffers"][name] = {{"file", name + ".bin"}, {"bytes", bytes.size()}};
    write_file(name + ".bin", bytes);
  }
  template <class Value>
  void write_values(const std::string& name, const std::vector<Value>& values) {
    write_buffer(name, {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)});
  }

  uint32_t write_shader(const std::string& stage, const std::string& file) {
    const std::vector<uint32_t> words =
        frontend::spirv_of_file(job_.shader_dir + "/" + file, pipeline::workload_options(job_));
    write_file(file + ".spv", {reinterpret_cast<const char*>(words.data()), words.size() * sizeof words[0]});
    frame_["shaders"].push_back({{"stage", stage}, {"file", file + ".spv"}, {"entry", "main"}});
    return uint32_t(frame_["shaders"].size() - 1);
  }

  void write_shaders() {
    Json groups = Json::array();
    groups.push_back({{"general", write_shader("raygen", "raygen.rgen")}});
    groups.push_back({{"general", write_shader("miss", "miss.rmiss")}});
    Json triangles = {{"closest_hit", write_shader("closest_hit", "triangle.rchit")}};
    if (job_.scene.alpha_test) triangles["any_hit"] = write_shader("any_hit", "alpha.rahit");
    groups.push_back(triangles);
    groups.push_back({{"closest_hit", write_shader("closest_hit", "sphere.rchit")},
                      {"intersection", write_shader("intersection", "sphere.rint")}});
    frame_["groups"] = groups;
    frame_["table"] = {{"raygen", 0}, {"miss", {1}}, {"hit", {2, 3}}, {"callable", Json::array()}};
    frame_["recursion"] = 1;
  }

  void write_geometry() {
    std::vector<scenes::Vertex> vertices;
    std::vector<uint32_t> indices;
    std::vector<std::array<uint32_t, 2>> offsets;  // first index and first vertex of each model
    std::vector<scenes::Vec4> spheres;
    std::vector<rt::Bounds> boxes;
    frame_["bottom_levels"] = Json::array();
    for (const Model& model : job_.scene.models) {
      offsets.push_back({uint32_t(indices.size()), uint32_t(vertices.size())});
      spheres.push_back(model.is_procedural() ? scenes::Vec4(model.center, model.radius) : scenes::Vec4(0));
      Json geometry;
      if (model.is_procedural()) {
        geometry = {
            {"boxes", {{"buffer", "boxes"}, {"offset", boxes.size() * sizeof(rt::Bounds)}, {"count", 1}}},
            {"flags", {kOpaque}}};
        boxes.push_back(pipeline::sphere_bounds(model));
      } else {
        geometry = {{"vertices",
                     {{"buffer", "vertices"},
                      {"offset", vertices.size() * sizeof(scenes::Vertex)},
                      {"stride", sizeof(scenes::Vertex)},
                      {"count", model.vertices.size()}}},
                    {"indices",
                     {{"buffer", "indices"},
                      {"offset", indices.size() * sizeof(uint32_t)},
                      {"count", model.indices.size()}}},
                    {"flags", {kNoDuplicates}}};
      }
      frame_["bottom_levels"].push_back({{"name", model.name}, {"geometries", {geometry}}});
      vertices.insert(vertices.end(), model.vertices.begin(), model.vertices.end());
      indices.insert(indices.end(), model.indices.begin(), model.indices.end());
    }
    write_values("vertices", vertices);
    write_values("indices", indices);
    write_values("boxes", boxes);
    write_values("offsets", offsets);
    write_values("spheres", spheres);
    write_values("materials", job_.scene.materials);
  }

  void write_instances() {
    std::vector<InstanceRecord> records;
    for (const scenes::Instance& placed : scenes::instances_of(job_.scene)) {
      const bool is_sphere = job_.scene.models[placed.model].is_procedural();
      InstanceRecord record;
      static_assert(sizeof record.transform == sizeof placed.to_world);
      std::memcpy(record.transform.data(), &placed.to_world, sizeof record.transform);
      record.index_and_mask = placed.model | kAllRays << 24;
      record.offset_and_flags = (is_sphere ? pipeline::kSphereRecord : 0) | kFacingCullDisable << 24;
      record.bottom = placed.model;
      records.push_back(record);
    }
    write_values("instances", records);
    frame_["instances"] = {{"buffer", "instances"}, {"offset", 0}, {"count", records.size()}};
  }

  Json write_textures() {
    Json images = Json::array();
    for (const scenes::Texture& texture : job_.scene.textures) {
      const std::string name = "texture_" + std::to_string(images.size());
      write_buffer(name, {reinterpret_cast<const char*>(texture.rgba.data()), texture.rgba.size()});
      images.push_back({{"buffer", name},
                        {"format", texture.srgb ? "rgba8_srgb" : "rgba8_unorm"},
                        {"size", {texture.width, texture.height}},
                        {"wrap", texture.repeat ? "repeat" : "clamp"}});
    }
    if (!images.empty()) return images;
    // A scene without textures binds one white texel, as `glint run` does.
    write_buffer("texture_0", std::string(4, '\xff'));
    images.push_back(
        {{"buffer", "texture_0"}, {"format", "rgba8_unorm"}, {"size", {1, 1}}, {"wrap", "clamp"}});
    return images;
  }

  void write_bindings() {
    const std::vector<std::byte> uniforms = scenes::uniform_block(job_.scene, job_.workload, job_.frame);
    write_buffer("frame", {reinterpret_cast<const char*>(uniforms.data()), uniforms.size()});
    Json bindings = Json::array();
    const auto image = [&](uint32_t binding) {
      bindings.push_back({{"binding", binding},
                          {"kind", "storage_image"},
                          {"format", "rgba32_float"},
                          {"size", {job_.frame.width, job_.frame.height}}});
    };
    const auto buffer = [&](uint32_t binding, const char* kind, const char* name) {
      bindings.push_back({{"binding", binding}, {"kind", kind}, {"buffer", name}});
    };
    bindings.push_back({{"binding", uint32_t(pipeline::kTopLevel)}, {"kind", "top_level"}});
    image(pipeline::kAccumulationImage);
    image(pipeline::kPictureImage);
    buffer(pipeline::kFrame, "uniform_buffer", "frame");
    buffer(pipeline::kVertices, "storage_buffer", "vertices");
    buffer(pipeline::kIndices, "storage_buffer", "indices");
    buffer(pipeline::kMaterials, "storage_buffer", "materials");
    buffer(pipeline::kOffsets, "storage_buffer", "offsets");
    bindings.push_back(
        {{"binding", uint32_t(pipeline::kTextures)}, {"kind", "textures"}, {"images", write_textures()}});
    buffer(pipeline::kSpheres, "storage_buffer", "spheres");
    frame_["bindings"] = bindings;
  }

  const pipeline::RenderJob& job_;
  std::string folder_;
  Json frame_;
  FrameFiles written_;
};

}  // namespace

FrameFiles write_frame(const pipeline::RenderJob& job, const std::string& name, const std::string& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw UserError({folder, 0, 0}, "cannot make this folder: " + failed.message());
  return FrameWriter(job, folder).write(name);
}

}  // namespace glint::app
