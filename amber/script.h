// Holds an Amber script as it was read: shaders, buffers, pipelines and the commands on them. Nothing is
// compiled yet.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "amber/type.h"
#include "base/diagnostics.h"
#include "exec/image_view.h"
#include "isa/program.h"
#include "rtunit/structure/build.h"

namespace glint::amber {

// This is the limit for a buffer in bytes; a larger size is a mistake.
inline constexpr uint64_t kMostBytes = uint64_t{1} << 31;

enum class Language : uint8_t { Glsl, SpirvText, SpirvHex, SpirvBinary };

struct Shader {
  std::string name;
  std::optional<isa::Stage> stage;  // none: several stages, and each ATTACH says which
  Language language = Language::Glsl;
  std::string text;        // begins with empty lines, so that its line numbers are the script's
  std::string target_env;  // empty: spv1.0 for SPIR-V
  std::string path;        // file to which the line numbers belong
};

struct Buffer {
  std::string name;
  Type type;
  Layout layout;
  bool is_image = false;
  uint32_t dimensions = 0;                // of an image
  std::array<uint32_t, 3> size{0, 0, 0};  // texels; also set for buffers with WIDTH
  uint32_t levels = 1, samples = 1;
  uint64_t elements = 0;
  std::vector<std::byte> bytes;
  SourceLocation where;
};

struct BottomLevel {
  struct Geometry {
    std::vector<float> vertices;
    std::vector<rt::Bounds> boxes;
    bool opaque = false, no_duplicate_any_hit = false;
  };
  std::vector<Geometry> geometries;
};
struct TopLevel {
  // Holds each instance with the name of its bottom level.
  std::vector<std::pair<std::string, rt::Instance>> instances;
};

struct Attachment {
  std::string shader;
  std::string entry = "main";
  std::optional<isa::Stage> stage;
  std::map<uint32_t, uint64_t> constants;  // bits, by constant_id
  bool is_clamped = false;                 // indices are clamped to what they index
};

enum class BindKind : uint8_t {
  Uniform,
  Storage,
  UniformTexels,
  StorageTexels,
  StorageImage,
  SampledImage,
  CombinedImage,
  Sampler,
  Structure,
  PushConstants
};

struct Binding {
  BindKind kind = BindKind::Storage;
  std::vector<std::string> names, samplers;  // more than one name: an array of descriptors
  uint32_t set = 0, binding = 0, base_level = 0;
  std::vector<uint64_t> offsets, ranges;  // bytes, one for each name or none
  SourceLocation where;
};

struct Pipeline {
  std::string name;
  bool is_ray_tracing = false;
  std::vector<Attachment> shaders;  // a compute pipeline has one
  std::set<std::string> clamped;    // shaders whose indices SHADER_OPTIMIZATION clamps
  std::vector<std::pair<std::string, std::vector<std::string>>> groups;
  std::map<std::string, std::vector<std::string>> tables;  // names of groups, by name of the table
  std::vector<std::string> libraries;
  std::vector<Binding> bindings;
  uint32_t max_trace_depth = 1;
  SourceLocation where;
};

enum class Comparator : uint8_t { Eq, Ne, Lt, Le, Gt, Ge, Rgb, Rgba, Buffer, Rmse, Histogram };

struct Expectation {
  std::string buffer, other;
  Comparator comparator = Comparator::Eq;
  uint32_t x = 0, y = 0, width = 0, height = 0;  // a place in bytes; for colours, in pixels
  std::optional<Layout> as;  // layout of the values from x on; none: the layout of the buffer
  std::vector<std::pair<double, bool>> tolerances;  // each with whether it is in percent
  std::vector<std::string> values;
};

struct Command {
  enum class Kind : uint8_t { Run, Expect, Copy, Write, Repeat } kind = Kind::Run;
  SourceLocation where;
  std::string pipeline;  // for Run
  std::array<uint32_t, 3> size{1, 1, 1};
  std::string raygen, miss, hit, callable;  // for Run: names of tables
  Expectation expect;
  std::string from, to;          // Copy uses both, Write only `to`
  uint32_t offset = 0;           // for Write
  std::vector<std::byte> bytes;  // for Write
  uint32_t count = 1;            // for Repeat
  std::vector<Command> body;
};

struct Script {
  std::string path;
  std::set<std::string> features;
  std::map<std::string, std::string> virtual_files;
  std::map<std::string, Type> structs;
  std::map<std::string, Shader> shaders;
  std::map<std::string, Buffer> buffers;
  std::map<std::string, exec::Sampler> samplers;
  std::map<std::string, BottomLevel> bottom_levels;
  std::map<std::string, TopLevel> top_levels;
  std::map<std::string, Pipeline> pipelines;
  std::vector<Command> commands;
};

// Reads a script in the language of docs/amber.md. Throws UserError with file and line where the script is
// wrong, and UnsupportedError with file, line and the name of what Glint lacks.
Script parse_script(const std::string& text, const std::string& path);
Script read_script(const std::string& path);

}  // namespace glint::amber
