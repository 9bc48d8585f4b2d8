// Uploads a scene: buffers in the original application's layout, one bottom level and instance per model.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/scene_world.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/host_threads.h"
#include "base/ordered_work.h"
#include "base/parallel_ranges.h"
#include "pipeline/binding_table.h"
#include "pipeline/linked_shaders.h"
#include "pipeline/software_traversal.h"
#include "pipeline/structure_cache.h"

namespace glint::pipeline {
namespace {

using scenes::Model;

constexpr uint64_t kLeastLarge = 50'000;  // primitives: a smaller model gains nothing from several threads
constexpr uint32_t kOcclusionReach = 0;   // constant_id in shaders/ambient_occlusion/raygen.rgen

uint64_t num_primitives(const Model& model, std::span<const uint32_t> indices) {
  return model.is_procedural() ? 1 : indices.size() / 3;
}

// Empties a vector and frees its memory, which clear() and `= {}` would keep.
template <class Value>
void release(std::vector<Value>& values) {
  std::vector<Value>().swap(values);
}

// Gives the host the pages that were freed between allocations that are still there. The C library keeps
// them.
void give_back_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

std::string name_of_binding(uint32_t binding, const char* name) {
  return fmt::format("binding {} ({})", binding, name);
}

template <class Value>
void copy(std::span<const Value> from, Value* to, uint32_t threads) {
  constexpr size_t kRange = 65536;  // values that a thread copies at a time
  parallel_ranges(from.size(), kRange, threads, [&](size_t begin, size_t end) {
    std::copy(from.data() + begin, from.data() + end, to + begin);
  });
}

}  // namespace

rt::Bounds sphere_bounds(const Model& model) {
  rt::Bounds box;
  for (size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = model.center[axis] - model.radius;
    box.high[axis] = model.center[axis] + model.radius;
  }
  return box;
}

frontend::GlslOptions workload_options(const RenderJob& job) {
  frontend::GlslOptions glsl = job.glsl;
  if (job.scene.alpha_test) glsl.defines.emplace_back("GLINT_ALPHA_TEST", "1");
  if (job.frame.ao_reach) {
    const float reach = scenes::diagonal(job.scene) * float(job.frame.ao_reach) / 100;
    glsl.specialization[kOcclusionReach] = std::bit_cast<uint32_t>(reach);
  }
  if (!job.scene.instances.empty()) glsl.defines.emplace_back("GLINT_INSTANCES", "1");
  return glsl;
}

WorkloadShaders compile_workload(const RenderJob& job) {
  WorkloadShaders out;
  const frontend::GlslOptions glsl = workload_options(job);
  const CompilerParams compiler = compiler_for(job.gpu);
  const frontend::BackendOptions backend = backend_options(compiler);
  auto compile = [&](const char* file) {
    out.programs.push_back(frontend::compile_file(job.shader_dir + "/" + file, glsl, backend, out.warnings));
    return uint32_t(out.programs.size() - 1);
  };
  out.raygen = compile("raygen.rgen");
  out.miss = compile("miss.rmiss");
  out.triangle.closest_hit = compile("triangle.rchit");
  if (job.scene.alpha_test) out.triangle.any_hit = compile("alpha.rahit");
  out.sphere.closest_hit = compile("sphere.rchit");
  out.sphere.intersection = compile("sphere.rint");
  return out;
}

SceneWorld::SceneWorld(const RenderJob& job, scenes::Scene* drain) {
  world.memory = &memory_;
  world.prints = job.prints;
  world.constant_bank.resize(isa::kConstantBankBytes);
  world.nearest_first_hit = job.gpu.rt.nearest_first_hit;
  world.any_hit = job.gpu.rt.any_hit.make({});
  if (job.gpu.rt.leaf_filter.name != rt::LeafFilter::kNone)
    world.filter = job.gpu.rt.leaf_filter.make({nullptr, memory_});
  world.layout = job.gpu.core.layout.make({});
  world.launch_size = {job.frame.width, job.frame.height, 1};
  world.first_id = {job.frame.crop_x, job.frame.crop_y, 0};
  world.whole_size = {job.frame.whole_width(), job.frame.whole_height(), 1};
  link_shaders(job);
  upload_geometry(job, drain);
  upload_images(job, drain);
  const std::vector<std::byte> frame = scenes::uniform_block(job.scene, job.workload, job.frame);
  frame_ = upload("binding 3 (frame)", frame.data(), frame.size());
  bind(kFrame, frame_, frame.size());
  if (job.scene.motion) moving_ = std::make_unique<Moving>(job);
  build_structures(job);
  mark_all_unbound(world, bound_);  // Shaders of a user's folder may ask for more.
}

void SceneWorld::link_shaders(const RenderJob& job) {
  WorkloadShaders shaders = compile_workload(job);
  add_traversal(shaders.programs, job.gpu, job.glsl.cache);
  warnings = shaders.warnings.messages();
  image_ = exec::link(shaders.programs);
  world.image = &image_;
  world.raygen = shaders.raygen;
  world.miss = {shaders.miss};
  world.hit = {shaders.triangle, shaders.sphere};
  world.local_bytes = local_bytes_ = stack_bytes(image_, world.max_trace_depth, 0);
  exec::place_plain_table(world, memory_.allocate("shader binding table", exec::plain_table_bytes(world)));
}

Address SceneWorld::upload(const std::string& name, const void* data, uint64_t bytes) {
  const Address address = memory_.allocate(name, std::max<uint64_t>(bytes, 4));
  if (bytes) memory_.write(address, data, bytes);
  return address;
}

Address SceneWorld::adopt(std::string name, const scenes::PackedContents& packed,
                          std::span<std::byte> bytes) {
  return memory_.adopt(std::move(name), mem::HostBlock(packed.memory, bytes.data(), bytes.size()));
}

void SceneWorld::bind(uint32_t binding, uint64_t address_or_handle, uint64_t bytes_or_count) {
  bound_.insert(binding);
  write_descriptor(world, {0, binding}, address_or_handle, bytes_or_count);
}

template <class Value>
std::span<Value> SceneWorld::bind_packed(uint32_t binding, const char* name,
                                         const scenes::PackedContents& packed, std::span<Value> values) {
  if (values.empty()) return bind_new<Value>(binding, name, 0);
  bind(binding, adopt(name_of_binding(binding, name), packed, std::as_writable_bytes(values)),
       values.size_bytes());
  return values;
}

template <class Value>
std::span<Value> SceneWorld::bind_new(uint32_t binding, const char* name, uint64_t count) {
  const uint64_t bytes = count * sizeof(Value);
  const Address address = memory_.allocate(name_of_binding(binding, name), std::max<uint64_t>(bytes, 4));
  bind(binding, address, bytes);
  return memory_.view<Value>(address, count);
}

void SceneWorld::upload_geometry(const RenderJob& job, scenes::Scene* drain) {
  const scenes::Scene& scene = job.scene;
  std::vector<std::array<uint32_t, 2>> offsets;  // first index and first vertex of each model
  std::vector<scenes::Vec4> spheres;
  uint64_t num_vertices = 0, num_indices = 0;
  for (size_t i = 0; i < scene.models.size(); ++i) {
    offsets.push_back({uint32_t(num_indices), uint32_t(num_vertices)});
    spheres.push_back(sphere_of(scene.models[i]));
    num_vertices += scene.vertices_of(i).size(), num_indices += scene.indices_of(i).size();
  }
  const scenes::PackedContents* const packed = drain ? drain->packed.get() : nullptr;
  const std::span vertices = packed ? bind_packed(kVertices, "vertices", *packed, packed->vertices)
                                    : bind_new<scenes::Vertex>(kVertices, "vertices", num_vertices);
  const std::span indices = packed ? bind_packed(kIndices, "indices", *packed, packed->indices)
                                   : bind_new<uint32_t>(kIndices, "indices", num_indices);
  const uint32_t threads = host_threads(job.threads);
  for (size_t i = 0; i < scene.models.size(); ++i) {
    const auto [first_index, first_vertex] = offsets[i];
    uploaded_.push_back({vertices.subspan(first_vertex, scene.vertices_of(i).size()),
                         indices.subspan(first_index, scene.indices_of(i).size())});
    if (packed) continue;
    copy(scene.vertices_of(i), vertices.data() + first_vertex, threads);
    copy(scene.indices_of(i), indices.data() + first_index, threads);
    if (!drain) continue;
    release(drain->models[i].vertices);
    release(drain->models[i].indices);
  }
  if (drain) give_back_memory();
  auto buffer = [&](uint32_t binding, const char* name, const auto& values) {
    const std::span to = bind_new<std::decay_t<decltype(values[0])>>(binding, name, values.size());
    std::copy(values.begin(), values.end(), to.begin());
  };
  buffer(kMaterials, "materials", scene.materials);
  buffer(kOffsets, "offsets", offsets);
  spheres_ = bind_new<scenes::Vec4>(kSpheres, "spheres", spheres.size());
  std::copy(spheres.begin(), spheres.end(), spheres_.begin());
}

void SceneWorld::upload_images(const RenderJob& job, scenes::Scene* drain) {
  using Format = exec::ImageView::Format;
  const auto add = [&](std::string name, Format format, uint32_t width, uint32_t height, Address base) {
    world.images.push_back({format, width, height, base, std::move(name)});
    return uint64_t(world.images.size() - 1);
  };
  const uint32_t width = job.frame.whole_width(), height = job.frame.whole_height();
  const auto add_output = [&](uint32_t binding, const char* what) {
    const std::string name = name_of_binding(binding, what);
    const uint64_t bytes = uint64_t{width} * height * exec::info_of(Format::Rgba32Float).bytes;
    bind(binding, add(name, Format::Rgba32Float, width, height, memory_.allocate(name, bytes)), 1);
  };
  add_output(kAccumulationImage, "accumulation");
  add_output(kPictureImage, "picture");
  const scenes::PackedContents* const packed = drain ? drain->packed.get() : nullptr;
  const uint64_t first = world.images.size();
  for (size_t i = 0; i < job.scene.textures.size(); ++i) {
    const scenes::Texture& texture = job.scene.textures[i];
    const std::string name = "texture " + texture.name;
    const std::span texels = job.scene.texels_of(i);
    const Address base = packed ? adopt(name, *packed, std::as_writable_bytes(packed->texels[i]))
                                : upload(name, texels.data(), texels.size());
    add(name, texture.srgb ? Format::Rgba8Srgb : Format::Rgba8Unorm, texture.width, texture.height, base);
    if (texture.repeat) world.images.back().sampler.wrap.fill(exec::Wrap::Repeat);
    const exec::ImageView& image = world.images.back();
    alpha_.push_back(
        {memory_.view<uint8_t>(image.base, image.bytes()), image.width, image.height, image.sampler.wrap[0]});
    if (drain) release(drain->textures[i].rgba);
  }
  // A scene without textures binds one white texel, as the original application does.
  static constexpr uint8_t kWhite[4] = {255, 255, 255, 255};
  if (job.scene.textures.empty())
    add("texture (white)", Format::Rgba8Unorm, 1, 1, upload("texture (white)", kWhite, sizeof kWhite));
  bind(kTextures, first, world.images.size() - first);
}

void SceneWorld::describe_bottom(const RenderJob& job, size_t index, BottomInput& out) const {
  const Model& model = job.scene.models[index];
  rt::Geometry& geometry = out.level.geometries.emplace_back();
  if (model.is_procedural()) {
    out.box = sphere_bounds(model);
    geometry.aabbs = {&out.box, 1};
    geometry.opaque = true;
    return;
  }
  geometry.positions = std::as_bytes(uploaded_[index].vertices);
  geometry.stride = sizeof(scenes::Vertex);
  geometry.indices = uploaded_[index].indices;
  geometry.opaque = false;  // The original sets NO_DUPLICATE_ANY_HIT and not OPAQUE.
  geometry.no_duplicate_any_hit = true;
}

rt::EncodedStructure SceneWorld::encode_bottom(const RenderJob& job, size_t index, uint32_t threads,
                                               rt::KeptTree* kept) const {
  const Model& model = job.scene.models[index];
  BottomInput input;
  describe_bottom(job, index, input);
  rt::Micromaps micromaps;
  // Without an alpha test the workload's rays ask no any-hit shader.
  if (const auto format = world.filter ? world.filter->micromaps() : std::nullopt;
      format && job.scene.alpha_test && !model.is_procedural()) {
    micromaps = bake(job, index, *format);
    input.level.geometries[0].micromaps = &micromaps;
  }
  const std::string name = name_of_model(model);
  // What moves is another structure in each frame, which no later run needs.
  return job.structure_cache && !deforms(index)
             ? job.structure_cache->encode(name, input.level, job.gpu.bvh, threads)
             : rt::encode_bottom(name, input.level, job.gpu.bvh, threads, kept);
}

rt::Micromaps SceneWorld::bake(const RenderJob& job, size_t index, const rt::MicromapFormat& format) const {
  return bake_opacity({uploaded_[index].vertices, uploaded_[index].indices, job.scene.materials, alpha_},
                      format);
}

// Builds the bottom levels on all threads, and places them in the order of the models, so that addresses do
// not depend on threads. The largest models come first, each on all threads, because one thread would still
// build them when the others have nothing left to do.
void SceneWorld::build_bottoms(const RenderJob& job) {
  const std::vector<Model>& models = job.scene.models;
  const uint32_t threads = host_threads(job.threads);
  uint64_t all = 0;
  for (size_t i = 0; i < models.size(); ++i) all += num_primitives(models[i], uploaded_[i].indices);
  std::map<size_t, rt::EncodedStructure> large;
  for (size_t i = 0; threads > 1 && i < models.size(); ++i)
    if (const uint64_t primitives = num_primitives(models[i], uploaded_[i].indices);
        primitives > kLeastLarge && primitives > all / (4 * threads))
      large.emplace(i, encode_bottom(job, i, threads, kept_tree(i)));
  OrderedWork<rt::EncodedStructure> work(models.size(), threads);
  work.run(
      [&](size_t i) {
        const auto built = large.find(i);
        return built != large.end() ? std::move(built->second) : encode_bottom(job, i, 1, kept_tree(i));
      },
      [&](size_t i, rt::EncodedStructure&& bottom) {
        bottoms_.push_back(place(name_of_model(models[i]), std::move(bottom), room_of_bottom(job, i)));
        structures.procedurals += models[i].is_procedural();
        structures.triangles += models[i].is_procedural() ? 0 : uploaded_[i].indices.size() / 3;
        structures.bytes += bottoms_.back().bytes;
        structures.bottom_depth = std::max(structures.bottom_depth, bottoms_.back().depth);
      });
}

std::vector<rt::Instance> SceneWorld::place_instances(const RenderJob& job) {
  std::vector<rt::Instance> instances;
  for (const scenes::Instance& placed : scenes::instances_of(job.scene)) {
    rt::Instance instance;
    instance.bottom = instance.custom_index = placed.model;
    instance.transform = std::bit_cast<std::array<float, 12>>(placed.to_world);
    instance.sbt_offset = job.scene.models[placed.model].is_procedural() ? kSphereRecord : 0;
    instance.flags = rt::instance_flag::kFacingCullDisable;
    instances.push_back(instance);
  }
  return instances;
}

void SceneWorld::build_structures(const RenderJob& job) {
  build_bottoms(job);
  const std::vector<rt::Instance> instances = place_instances(job);
  const uint64_t room = moving_ ? rt::most_bytes(1, instances.size(), job.gpu.bvh) : 0;
  top_ = place(kTopName, encode_top(job, instances), room);
  structures.bytes += top_.bytes;
  structures.top_depth = top_.depth;
  structures.bottom_levels = bottoms_.size();
  structures.instances = instances.size();
  bind_top();
}

void SceneWorld::bind_top() {
  world.local_bytes = local_bytes_;
  place_records(world, top_.stack_need);
  bind(kTopLevel, top_.address, top_.bytes);
}

std::vector<float> SceneWorld::read_image(uint32_t handle) const {
  const exec::ImageView& image = world.images[handle];
  GLINT_CHECK(image.format == exec::ImageView::Format::Rgba32Float, "image {} is not float", image.name);
  const auto texels = memory_.view<float>(image.base, uint64_t(image.width) * image.height * 4);
  std::vector<float> out;
  for (uint64_t y = 0; y < world.launch_size[1]; ++y) {
    const uint64_t first = ((world.first_id[1] + y) * image.width + world.first_id[0]) * 4;
    out.insert(out.end(), texels.begin() + first,
               texels.begin() + first + uint64_t{world.launch_size[0]} * 4);
  }
  return out;
}

}  // namespace glint::pipeline
