// Binds what a pipeline names, runs the pipeline and reads the buffers back.
// SPDX-License-Identifier: Apache-2.0
#include "amber/launch.h"

#include <algorithm>
#include <cstddef>
#include <fmt/format.h>
#include <utility>

#include "amber/declared_binding.h"
#include "pipeline/launch_builder.h"

namespace glint::amber {
namespace {

// Choice: this is the depth to which callables may nest. Scripts cannot say it, and Vulkan leaves it to the
// size of the stack.
constexpr uint32_t kCallableDepth = 8;

// Returns whether the script asks for one of robustBufferAccess, robustBufferAccess2, robustImageAccess and
// robustImageAccess2. Choice: each of them covers buffers and images.
bool declares_robust_access(const Script& script) {
  return std::any_of(script.features.begin(), script.features.end(), [](const std::string& feature) {
    return feature.find("robustBufferAccess") != std::string::npos ||
           feature.find("robustImageAccess") != std::string::npos;
  });
}

std::vector<isa::Program> programs_of(const std::vector<CompiledShader>& shaders) {
  std::vector<isa::Program> out;
  for (const CompiledShader& shader : shaders) out.push_back(shader.program);
  return out;
}

std::vector<frontend::Binding> bindings_of(const std::vector<CompiledShader>& shaders) {
  std::vector<frontend::Binding> out;
  for (const CompiledShader& shader : shaders)
    out.insert(out.end(), shader.reflection.bindings.begin(), shader.reflection.bindings.end());
  return out;
}

pipeline::BindingPlace place_of(const Binding& binding) {
  return {binding.set, binding.binding};
}

class Launch {
 public:
  Launch(Script& script, const Command& command, const CompiledPipeline& code, ScriptMemory& memory,
         const LaunchOptions& options)
      : script_(script),
        command_(command),
        pipeline_(script.pipelines.at(command.pipeline)),
        shaders_(code.shaders),
        memory_(memory),
        builder_(code.linked, memory.space) {
    exec::World& world = builder_.world;
    world.robust_images = world.robust_buffers = !options.strict || declares_robust_access(script);
    world.on_fault = options.on_fault;
    world.prints = options.prints;
    for (const Binding& binding : pipeline_.bindings) bind(binding);
    if (pipeline_.is_ray_tracing)
      set_ray_tracing();
    else
      set_compute();
    builder_.finish(stack_need_);
  }
  Launch(const Launch&) = delete;
  Launch& operator=(const Launch&) = delete;
  ~Launch() {
    for (const Address each : builder_.allocations()) memory_.space.free(each);
  }

  const exec::World& world() const { return builder_.world; }
  std::string shaders() const {
    std::string out;
    for (const CompiledShader& shader : shaders_) out += (out.empty() ? "" : " ") + shader.name;
    return out;
  }

 private:
  void set_compute();
  void set_ray_tracing();
  void bind(const Binding& binding);
  void bind_buffers(const Binding& binding);
  void bind_images(const Binding& binding);
  void bind_samplers(const Binding& binding);
  void bind_structures(const Binding& binding);
  void set_push_constants(const Binding& binding);
  exec::ImageView view_of(const Binding& binding, const Buffer& buffer, size_t element);
  pipeline::TableRecord record(const std::string& group, pipeline::TableInput& input);
  pipeline::TableRegion region(const std::string& table, pipeline::TableInput& input);
  std::vector<pipeline::TableRecord> records(const std::string& table, pipeline::TableInput& input);

  Script& script_;
  const Command& command_;
  const Pipeline& pipeline_;
  const std::vector<CompiledShader>& shaders_;
  ScriptMemory& memory_;
  pipeline::LaunchBuilder builder_;
  uint32_t stack_need_ = 0;  // entries for the deepest structure
};

void Launch::set_compute() {
  if (shaders_.empty())
    throw UserError(pipeline_.where, fmt::format("pipeline '{}' has no shader", pipeline_.name));
  builder_.set_blocks(0, command_.size, command_.where);
}

pipeline::TableRecord Launch::record(const std::string& group, pipeline::TableInput& input) {
  for (const auto& [name, shaders] : all_groups(script_, pipeline_)) {
    if (name != group) continue;
    pipeline::ShaderGroup made;
    for (const std::string& shader : shaders) {
      const auto found = std::find_if(shaders_.begin(), shaders_.end(),
                                      [&](const CompiledShader& s) { return s.name == shader; });
      const auto index = uint32_t(found - shaders_.begin());
      const isa::Stage stage = found->program.stage;
      (stage == isa::Stage::ClosestHit     ? made.hit.closest_hit
       : stage == isa::Stage::AnyHit       ? made.hit.any_hit
       : stage == isa::Stage::Intersection ? made.hit.intersection
                                           : made.general) = index;
    }
    input.groups.push_back(made);
    return {uint32_t(input.groups.size() - 1), {}};
  }
  throw UserError(pipeline_.where,
                  fmt::format("pipeline '{}' has no shader group '{}'", pipeline_.name, group));
}

std::vector<pipeline::TableRecord> Launch::records(const std::string& table, pipeline::TableInput& input) {
  std::vector<pipeline::TableRecord> out;
  if (!table.empty())
    for (const std::string& group : pipeline_.tables.at(table)) out.push_back(record(group, input));
  return out;
}

// Returns the region of a binding table. Without a table every index calls nothing, as with a Vulkan region
// at address 0.
pipeline::TableRegion Launch::region(const std::string& table, pipeline::TableInput& input) {
  pipeline::TableRegion out;
  out.records = records(table, input);
  if (out.records.empty()) out.records.resize(1), out.stride = 0;
  return out;
}

void Launch::set_ray_tracing() {
  pipeline::TableInput input;
  const std::vector<pipeline::TableRecord> raygen = records(command_.raygen, input);
  if (raygen.empty()) throw UserError(command_.where, "the RAYGEN table is empty");
  input.raygen = raygen[0];
  input.miss = region(command_.miss, input);
  input.hit = region(command_.hit, input);
  input.callable = region(command_.callable, input);
  builder_.set_rays(command_.size, pipeline_.max_trace_depth, kCallableDepth, command_.where);
  builder_.set_records(input);
}

void Launch::bind(const Binding& binding) {
  check_kind(binding, shaders_);
  switch (binding.kind) {
    case BindKind::Uniform:
    case BindKind::Storage:
      return bind_buffers(binding);
    case BindKind::Sampler:
      return bind_samplers(binding);
    case BindKind::Structure:
      return bind_structures(binding);
    case BindKind::PushConstants:
      return set_push_constants(binding);
    default:
      return bind_images(binding);
  }
}

void Launch::bind_buffers(const Binding& binding) {
  std::vector<pipeline::BufferRange> all;
  for (size_t i = 0; i < binding.names.size(); ++i) {
    const Buffer& buffer = script_.buffers.at(binding.names[i]);
    const uint64_t offset = i < binding.offsets.size() ? binding.offsets[i] : 0;
    if (offset >= buffer.bytes.size())
      throw UserError(binding.where, fmt::format("the offset {} is past the end of buffer '{}' ({} bytes)",
                                                 offset, buffer.name, buffer.bytes.size()));
    const uint64_t rest = buffer.bytes.size() - offset,
                   bytes = i < binding.ranges.size() ? std::min(rest, binding.ranges[i]) : rest;
    all.push_back({memory_.buffers.range(buffer, offset, offset + bytes), bytes});
  }
  builder_.bind_buffers(place_of(binding), all);
}

exec::ImageView Launch::view_of(const Binding& binding, const Buffer& buffer, size_t element) {
  const bool is_texels = binding.kind == BindKind::UniformTexels || binding.kind == BindKind::StorageTexels;
  if (!buffer.type.format)
    throw UnsupportedError(
        fmt::format("{}: unsupported: images of {}", binding.where.to_string(), buffer.type.name));
  if (buffer.layout.stride != exec::info_of(*buffer.type.format).bytes)
    throw UnsupportedError(fmt::format("{}: unsupported: texels with gaps", binding.where.to_string()));
  exec::ImageView view;
  view.name = buffer.name, view.format = *buffer.type.format;
  view.width = buffer.size[0] && !is_texels ? buffer.size[0] : uint32_t(buffer.elements);
  view.height = is_texels ? 1 : std::max(1u, buffer.size[1]),
  view.depth = is_texels ? 1 : std::max(1u, buffer.size[2]);
  view.levels = is_texels ? 1 : buffer.levels;
  view.samples = view.layers = buffer.samples;
  const uint32_t dimensions = buffer.dimensions ? buffer.dimensions : 2;
  const frontend::Binding* use = reflected(binding, shaders_);
  view.shape = use               ? use->shape
               : is_texels       ? isa::ImageShape::Buffer
               : dimensions == 1 ? isa::ImageShape::D1
               : dimensions == 2 ? isa::ImageShape::D2
                                 : isa::ImageShape::D3;
  view.base =
      memory_.buffers.whole(buffer) + (element < binding.offsets.size() ? binding.offsets[element] : 0);
  if (binding.base_level >= view.levels)
    throw UserError(binding.where, fmt::format("'{}' has {} levels", buffer.name, view.levels));
  view = exec::part_of(
      view,
      {.first_level = binding.base_level, .levels = view.levels - binding.base_level, .layers = view.layers});
  if (element < binding.samplers.size()) view.sampler = script_.samplers.at(binding.samplers[element]);
  return view;
}

void Launch::bind_images(const Binding& binding) {
  std::vector<exec::ImageView> all;
  for (size_t i = 0; i < binding.names.size(); ++i)
    all.push_back(view_of(binding, script_.buffers.at(binding.names[i]), i));
  builder_.bind_images(place_of(binding), std::move(all));
}

void Launch::bind_samplers(const Binding& binding) {
  std::vector<exec::Sampler> all;
  for (const std::string& name : binding.names) all.push_back(script_.samplers.at(name));
  builder_.bind_samplers(place_of(binding), std::move(all));
}

void Launch::bind_structures(const Binding& binding) {
  std::vector<pipeline::BufferRange> all;
  for (const std::string& name : binding.names) {
    const rt::StructureInfo& top = memory_.structures.top_level(name);
    stack_need_ = std::max(stack_need_, top.stack_need);
    all.push_back({top.address, 0});
  }
  builder_.bind_buffers(place_of(binding), all);
}

void Launch::set_push_constants(const Binding& binding) {
  const Buffer& buffer = script_.buffers.at(binding.names[0]);
  builder_.set_push_constants(buffer.bytes, 0, binding.where);
}

}  // namespace

CompiledPipeline::CompiledPipeline(std::vector<CompiledShader> compiled, const LaunchOptions& options)
    : shaders(std::move(compiled)),
      linked(programs_of(shaders), bindings_of(shaders), options.gpu, options.cache) {
}

Launched launch(Script& script, const Command& command, const CompiledPipeline& code, ScriptMemory& memory,
                pipeline::Device& device, const LaunchOptions& options, uint32_t number) {
  // In Vulkan such a launch does nothing.
  if (command.size[0] == 0 || command.size[1] == 0 || command.size[2] == 0) return {};
  const Launch launch(script, command, code, memory, options);
  Launched out{.is_launch = true};
  const auto run = [&] {
    pipeline::RenderResult result = device.run(launch.world(), options.mode, options.watch);
    out.end = result.end, out.cycles = result.cycles, out.faults = result.faults;
    return result;
  };
  if (options.record)
    options.record({number, command.pipeline, launch.shaders(), launch.world()}, run);
  else
    run();
  for (auto& [name, buffer] : script.buffers) memory.buffers.read_back(buffer);
  return out;
}

}  // namespace glint::amber
