// Reads PIPELINE and DERIVE_PIPELINE: shaders, groups, tables and bindings.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstring>

#include "amber/parse.h"
#include "isa/descriptors.h"

namespace glint::amber {
namespace {

constexpr int64_t kSubgroupSize = 32;  // threads of a warp

void parse_constant(Parsing& p, Attachment& attachment) {
  const uint32_t id = p.tokens.number("the constant's number");
  if (!p.tokens.accept("AS")) p.wrong("AS is missing");
  const std::string name = p.tokens.word("the constant's type"),
                    value = p.tokens.word("the constant's value");
  const std::optional<Type> type = type_named(name);
  std::byte bytes[8]{};
  if (!type || type->rows != 1 || type->columns != 1 || !put(type->scalar, value, bytes))
    p.wrong(fmt::format("'{}' is not a {}", value, name));
  uint64_t bits = 0;
  std::memcpy(&bits, bytes, sizeof bits);
  attachment.constants[id] = bits;
}

void parse_attach(Parsing& p, Pipeline& pipeline) {
  Attachment attachment;
  attachment.shader = p.tokens.word("the shader");
  const Shader& shader = p.find(p.script.shaders, attachment.shader, "shader");
  attachment.stage = shader.stage;
  while (p.tokens.peek().is_word()) {
    const std::string name = p.tokens.next().text;
    if (name == "TYPE")
      attachment.stage = stage_named(p, p.tokens.word("the type"));
    else if (name == "ENTRY_POINT")
      attachment.entry = p.tokens.word("the entry point");
    else if (name == "SPECIALIZE")
      parse_constant(p, attachment);
    else
      p.unsupported("ATTACH " + name);
  }
  if (!attachment.stage) p.wrong(fmt::format("'{}' is a multi shader: TYPE is missing", attachment.shader));
  if ((*attachment.stage == isa::Stage::Compute) == pipeline.is_ray_tracing)
    p.wrong(fmt::format("'{}' is not a shader for this kind of pipeline", attachment.shader));
  if (!pipeline.is_ray_tracing && !pipeline.shaders.empty()) p.wrong("a compute pipeline has one shader");
  pipeline.shaders.push_back(attachment);
}

void parse_subgroup(Parsing& p) {
  p.find(p.script.shaders, p.tokens.word("the shader"), "shader");
  Token token = p.tokens.next_after_line_ends();
  for (; token.is_word() && token.text != "END"; token = p.tokens.next_after_line_ends()) {
    const std::string name = token.text, value = p.tokens.word("a value");
    int64_t size = 0;
    if (name == "FULLY_POPULATED" || name == "VARYING_SIZE") {
      if (value != "on" && value != "off") p.wrong(fmt::format("'{}' is neither on nor off", value));
    } else if (name != "REQUIRED_SIZE") {
      p.unsupported("SUBGROUP " + name);
    } else if (value != "MIN" && value != "MAX" && (!parse_integer(value, size) || size != kSubgroupSize)) {
      p.unsupported(
          fmt::format("SUBGROUP REQUIRED_SIZE {}: subgroups have {} threads", value, kSubgroupSize));
    }
  }
  if (!token.is_word()) p.wrong("END is missing");
}

BindKind kind_named(Parsing& p, const std::string& name) {
  const std::map<std::string, BindKind> kinds{{"uniform", BindKind::Uniform},
                                              {"uniform_dynamic", BindKind::Uniform},
                                              {"storage", BindKind::Storage},
                                              {"storage_dynamic", BindKind::Storage},
                                              {"uniform_texel_buffer", BindKind::UniformTexels},
                                              {"storage_texel_buffer", BindKind::StorageTexels},
                                              {"storage_image", BindKind::StorageImage},
                                              {"sampled_image", BindKind::SampledImage},
                                              {"combined_image_sampler", BindKind::CombinedImage},
                                              {"push_constant", BindKind::PushConstants}};
  if (const auto found = kinds.find(name); found != kinds.end()) return found->second;
  if (name == "color" || name == "depth_stencil" || name == "resolve") p.unsupported("graphics: attachments");
  p.unsupported("BIND BUFFER AS " + name);
}

bool is_attribute(const std::string& word) {
  for (const char* name : {"AS", "DESCRIPTOR_SET", "BINDING", "OFFSET", "DESCRIPTOR_OFFSET",
                           "DESCRIPTOR_RANGE", "BASE_MIP_LEVEL", "SAMPLER", "KERNEL"})
    if (word == name) return true;
  return false;
}

// Adds a list of bytes to `to`, element by element, because a binding may have several lists of offsets.
void parse_bytes(Parsing& p, std::vector<uint64_t>& to) {
  for (size_t i = 0; p.tokens.peek().is_word() && !is_attribute(p.tokens.peek().text); ++i) {
    int64_t value = 0;
    if (!parse_integer(p.tokens.next().text, value)) p.wrong("a number of bytes is expected");
    if (i >= to.size()) to.push_back(0);
    to[i] += uint64_t(value);
  }
}

void parse_bind_attributes(Parsing& p, Binding& binding, bool& has_kind) {
  while (p.tokens.peek().is_word()) {
    const std::string name = p.tokens.next().text;
    if (name == "AS")
      binding.kind = kind_named(p, p.tokens.word("what it is bound as")), has_kind = true;
    else if (name == "DESCRIPTOR_SET")
      binding.set = uint32_t(p.tokens.integer("the set", 0, isa::kMaxSets - 1));
    else if (name == "BINDING")
      binding.binding = uint32_t(p.tokens.integer("the binding", 0, isa::kMaxBindings - 1));
    else if (name == "OFFSET" || name == "DESCRIPTOR_OFFSET")
      parse_bytes(p, binding.offsets);
    else if (name == "DESCRIPTOR_RANGE")
      parse_bytes(p, binding.ranges);
    else if (name == "BASE_MIP_LEVEL")
      binding.base_level = p.tokens.number("the level");
    else if (name == "KERNEL")
      p.unsupported("OpenCL: arguments of kernels");
    else if (name == "SAMPLER")
      while (p.tokens.peek().is_word() && !is_attribute(p.tokens.peek().text))
        binding.samplers.push_back(p.tokens.next().text);
    else
      p.unsupported("BIND " + name);
  }
}

void parse_bind(Parsing& p, Pipeline& pipeline) {
  Binding binding;
  binding.where = p.tokens.here();
  const std::string what = p.tokens.word("what is bound");
  const bool is_sampler = what.rfind("SAMPLER", 0) == 0, is_structure = what == "ACCELERATION_STRUCTURE";
  if (!is_structure && what != "BUFFER" && what != "IMAGE" && what != "SAMPLER" && what != "BUFFER_ARRAY" &&
      what != "IMAGE_ARRAY" && what != "SAMPLER_ARRAY")
    p.unsupported("BIND " + what);
  const bool is_array = what.ends_with("_ARRAY");
  do binding.names.push_back(p.tokens.word("a name"));
  while (is_array && p.tokens.peek().is_word() && !is_attribute(p.tokens.peek().text));
  bool has_kind = is_sampler || is_structure;
  if (has_kind) binding.kind = is_sampler ? BindKind::Sampler : BindKind::Structure;
  for (const std::string& name : binding.names) {
    if (is_sampler)
      p.find(p.script.samplers, name, "sampler");
    else if (is_structure)
      p.find(p.script.top_levels, name, "top level");
    else
      p.find(p.script.buffers, name, "buffer");
  }
  parse_bind_attributes(p, binding, has_kind);
  if (!has_kind) p.unsupported("BIND BUFFER without AS");
  for (const std::string& name : binding.samplers) p.find(p.script.samplers, name, "sampler");
  if (binding.kind == BindKind::CombinedImage && binding.samplers.size() != binding.names.size())
    p.wrong("each combined image needs one SAMPLER");
  // A derived pipeline replaces the parent's binding.
  std::erase_if(pipeline.bindings, [&](const Binding& other) {
    return other.kind == BindKind::PushConstants || binding.kind == BindKind::PushConstants
               ? other.kind == binding.kind
               : other.set == binding.set && other.binding == binding.binding;
  });
  pipeline.bindings.push_back(binding);
}

void parse_table(Parsing& p, Pipeline& pipeline) {
  std::vector<std::string>& table =
      p.declare(pipeline.tables, p.tokens.word("the table's name"), "shader binding table");
  Token token = p.tokens.next_after_line_ends();
  for (; token.is_word() && token.text != "END"; token = p.tokens.next_after_line_ends())
    table.push_back(token.text);
  if (!token.is_word()) p.wrong("END is missing");
}

void parse_group(Parsing& p, Pipeline& pipeline) {
  const std::string name = p.tokens.word("the group's name");
  for (const auto& [other, shaders] : pipeline.groups)
    if (other == name) p.wrong(fmt::format("there is a group '{}' already", name));
  std::vector<std::string> shaders;
  while (p.tokens.peek().is_word()) {
    shaders.push_back(p.tokens.next().text);
    if (p.find(p.script.shaders, shaders.back(), "shader").stage == isa::Stage::Compute)
      p.wrong("a group cannot hold a compute shader");
  }
  if (shaders.empty()) p.wrong(fmt::format("group '{}' has no shader", name));
  pipeline.groups.emplace_back(name, shaders);
}

// Reads a list that stands on the line, or on the lines up to END.
std::vector<std::string> parse_list(Parsing& p) {
  std::vector<std::string> out;
  const bool is_long = !p.tokens.peek().is_word();
  if (!is_long) {
    while (p.tokens.peek().is_word()) out.push_back(p.tokens.next().text);
    return out;
  }
  Token token = p.tokens.next_after_line_ends();
  for (; token.is_word() && token.text != "END"; token = p.tokens.next_after_line_ends())
    out.push_back(token.text);
  if (!token.is_word()) p.wrong("END is missing");
  return out;
}

bool parse_ray_tracing_line(Parsing& p, const std::string& name, Pipeline& pipeline) {
  if (name == "SHADER_GROUP")
    parse_group(p, pipeline);
  else if (name == "SHADER_BINDING_TABLE")
    parse_table(p, pipeline);
  else if (name == "MAX_RAY_PAYLOAD_SIZE" || name == "MAX_RAY_HIT_ATTRIBUTE_SIZE")
    p.tokens.number("the size");  // ignored, because the sizes in the shaders count
  else if (name == "MAX_RAY_RECURSION_DEPTH")
    pipeline.max_trace_depth = uint32_t(p.tokens.integer("the depth", 0, 31));
  else if (name == "FLAGS") {
    for (const std::string& flag : parse_list(p))
      if (flag != "LIBRARY") p.unsupported("pipeline flag " + flag);
  } else if (name == "USE_LIBRARY") {
    for (const std::string& library : parse_list(p))
      p.find(p.script.pipelines, library, "pipeline"), pipeline.libraries.push_back(library);
  } else
    return false;
  return true;
}

// Reads SHADER_OPTIMIZATION. Passes of the optimiser are ignored, except the one that clamps a shader's
// indices, because the others do not change what a shader does.
void parse_optimization(Parsing& p, Pipeline& pipeline) {
  int unused = 0;
  const std::string shader = p.tokens.word("the shader");
  p.find(p.script.shaders, shader, "shader");
  if (p.tokens.raw_until_end(unused).find("graphics-robust-access") != std::string::npos)
    pipeline.clamped.insert(shader);
}

void parse_body(Parsing& p, Pipeline& pipeline) {
  Token token = p.tokens.next_after_line_ends();
  for (; token.is_word() && token.text != "END"; token = p.tokens.next_after_line_ends()) {
    const std::string& name = token.text;
    int unused = 0;
    if (name == "ATTACH")
      parse_attach(p, pipeline);
    else if (name == "BIND")
      parse_bind(p, pipeline);
    else if (name == "SUBGROUP")
      parse_subgroup(p);
    else if (name == "COMPILE_OPTIONS")
      p.tokens.word("the shader"), p.tokens.raw_until_end(unused);
    else if (name == "SHADER_OPTIMIZATION")
      parse_optimization(p, pipeline);
    else if (name == "FRAMEBUFFER_SIZE")
      p.tokens.number("the width"), p.tokens.number("the height");
    else if (name == "SET")
      p.unsupported("OpenCL: SET KERNEL");
    else if (!pipeline.is_ray_tracing || !parse_ray_tracing_line(p, name, pipeline))
      p.unsupported("in a pipeline: " + name);
    p.tokens.end_line();
  }
  if (!token.is_word()) p.wrong("END is missing");
}

}  // namespace

void parse_pipeline(Parsing& p) {
  Pipeline pipeline;
  pipeline.where = p.tokens.here();
  const std::string kind = p.tokens.word("the pipeline's kind");
  if (kind == "graphics") p.unsupported("graphics pipelines");
  if (kind != "compute" && kind != "raytracing") p.unsupported("pipelines of kind " + kind);
  pipeline.is_ray_tracing = kind == "raytracing";
  pipeline.name = p.tokens.word("the pipeline's name");
  p.tokens.end_line();
  parse_body(p, pipeline);
  p.declare(p.script.pipelines, pipeline.name, "pipeline") = pipeline;
}

void parse_derived_pipeline(Parsing& p) {
  const std::string name = p.tokens.word("the pipeline's name");
  if (!p.tokens.accept("FROM")) p.wrong("FROM is missing");
  Pipeline pipeline = p.find(p.script.pipelines, p.tokens.word("the parent"), "pipeline");
  pipeline.name = name, pipeline.where = p.tokens.here();
  p.tokens.end_line();
  parse_body(p, pipeline);
  p.declare(p.script.pipelines, name, "pipeline") = pipeline;
}

}  // namespace glint::amber
