// Holds a pipeline as a file describes it, with everything that a Vulkan host sets up. Nothing is loaded yet.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "exec/image_view.h"
#include "frontend/compile.h"
#include "pipeline/description/value.h"
#include "rtunit/structure/build.h"

namespace glint::pipeline {

struct ShaderFile {
  std::string name;  // the name for records: the file as written, unless it is named
  std::string path;
  std::string entry;  // entry point of a SPIR-V module; empty: its only one
  frontend::GlslOptions glsl;
  SourceLocation where;
};

// Describes the bytes of a buffer, of a record or of push constants.
struct DataSource {
  SourceLocation where;
  // numbers of `type`, {TYPE = numbers} or a list of such, or members by name; without any of these, `init`
  // applies
  Value data;
  std::string type = "u32";
  std::string init = "zero";  // zero, value, iota, random, file, mesh
  double value = 0, low = 0, high = 1;
  uint64_t seed = 1;
  std::string file, attribute;    // attribute of a mesh: positions, normals, coordinates, indices
  std::optional<uint64_t> bytes;  // empty: as many as the data have
};

// Says where a resource is bound. A resource that is reached only by address or name is not bound.
struct Slot {
  std::optional<uint32_t> set, binding;
  uint32_t element = 0;  // index into an array of descriptors
  bool is_bound() const { return binding.has_value(); }
};

struct Save {
  std::string file;  // .png .pfm .exr .npy .csv .raw, in the run directory
  SourceLocation where;
};

struct BufferDescription {
  std::string name;
  Slot slot;
  DataSource data;
  std::vector<Save> saves;
  uint32_t show = 0;  // how many of the first values the summary shows
  SourceLocation where;
};

struct SamplerDescription {
  std::string name;
  Slot slot;
  exec::Sampler sampler;
  SourceLocation where;
};

struct ImageDescription {
  std::string name;
  Slot slot;
  std::vector<std::string> files;  // one per layer
  std::optional<exec::TexelFormat> format;
  std::array<uint32_t, 3> size{0, 0, 0};  // zeros: the size of the file, or of the launch
  uint32_t layers = 1, samples = 1;
  bool mipmaps = false;
  std::string init = "zero";  // zero, value, checker, random, data
  std::array<double, 4> value{0, 0, 0, 0};
  std::vector<double> data;  // the format's channels of each texel: x first, then y, z and layers
  uint64_t seed = 1;
  exec::Sampler sampler;  // Its border has bits of floats.
  std::array<double, 4> border{0, 0, 0, 0};
  bool has_filter = false;  // Without one, images of integers take the nearest texel.
  std::vector<Save> saves;
  SourceLocation where;
};

// Describes an image that kernels of a launch file read or write, and what its accesses take it for.
struct KernelImage {
  ImageDescription image;
  isa::ImageShape shape = isa::ImageShape::D2;
};

// Holds opacity micromaps as a file has them: one map for each text of digits, each of which is a state.
struct OpacityDescription {
  struct Map {
    rt::MicromapFormat format;
    std::vector<uint8_t> states;  // packed, as rt::Micromaps::states
  };
  std::vector<Map> maps;
  std::vector<int32_t> index;  // as rt::Micromaps::index; empty: each triangle has the map of its number
  SourceLocation where;
};

struct GeometryDescription {
  std::string mesh;  // an OBJ or glTF file
  std::vector<float> vertices;
  std::vector<uint32_t> indices;
  std::vector<rt::Bounds> aabbs;
  std::array<float, 12> transform = rt::kIdentity;
  bool opaque = true, no_duplicate_any_hit = false;
  std::optional<OpacityDescription> opacity;
  SourceLocation where;
};

struct BottomLevelDescription {
  std::string name;
  std::vector<GeometryDescription> geometries;
  SourceLocation where;
};

struct InstanceDescription {
  std::string bottom_level;
  rt::Instance instance;
  SourceLocation where;
};

struct TopLevelDescription {
  std::string name;
  Slot slot;
  std::vector<InstanceDescription> instances;
  SourceLocation where;
};

// Describes a record of the binding table by the names of shaders, or by a named group. Without any, the
// record calls nothing.
struct GroupDescription {
  std::string name;
  std::string general, closest_hit, any_hit, intersection;
  SourceLocation where;
};
struct RecordDescription {
  std::string group;         // name of a [[group]]
  GroupDescription inlined;  // used without `group`
  DataSource data;
  SourceLocation where;
};
struct RegionDescription {
  std::vector<RecordDescription> records;
  std::optional<uint32_t> stride;
  SourceLocation stride_where;
};

struct MachineDescription {
  std::string mode, config;  // empty: not given
  std::vector<std::string> settings;
  uint64_t max_instructions = 0;
};

// Describes one launch of a file: what runs, how often, and what the caches hold when it begins.
struct LaunchDescription {
  std::string name;                         // names its results; empty: the file has one launch, [launch]
  std::optional<RecordDescription> raygen;  // a launch has either this or a compute shader
  std::string compute;
  std::array<uint32_t, 3> size{0, 0, 0};  // rays, or blocks of the compute shader; zeros: not given
  std::optional<uint32_t> max_trace_depth, max_callable_depth;
  DataSource push_constants;
  bool warm = false;  // It begins with what the launch before it has left in the L2.
  SourceLocation where;
};

struct PipelineDescription {
  std::string path;  // path of the file
  std::string name;  // name for the run directory and messages
  std::vector<ShaderFile> shaders;
  std::vector<GroupDescription> groups;
  std::vector<LaunchDescription> launches;  // in order; at least one
  RegionDescription miss, hit, callable;
  std::vector<BufferDescription> buffers;
  std::vector<ImageDescription> images;
  std::vector<SamplerDescription> samplers;
  std::vector<BottomLevelDescription> bottom_levels;
  std::vector<TopLevelDescription> top_levels;
  Value specialization;  // a table of constants by name or number
  MachineDescription machine;
};

// Reads a pipeline file; docs/pipelines.md describes the format. Throws UserError that lists every mistake
// with file, line and column.
PipelineDescription read_pipeline(const std::string& path);
// Does the same for a text whose relative paths start at the folder of `path`.
PipelineDescription parse_pipeline(const std::string& text, const std::string& path);

// Returns the format "rgba8_unorm", or one by GLSL's name: "rgba8", "rgba32f", "r32ui".
std::optional<exec::TexelFormat> format_named(const std::string& name);
std::vector<std::string> format_names();

}  // namespace glint::pipeline
