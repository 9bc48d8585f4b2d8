// Builds the world as the recording host program did: structures, buffers, groups, records.
// SPDX-License-Identifier: Apache-2.0
#include "tests/vulkan_rt/conformance_world.h"

#include <cstring>
#include <map>

#include "base/registry.h"
#include "frontend/compile.h"
#include "isa/verify.h"
#include "pipeline/functional_machine.h"
#include "pipeline/software_traversal.h"
#include "pipeline/timing_machine.h"
#include "rtunit/structure/build.h"
#include "tests/support/kept_shaders.h"

namespace glint::vulkan_rt {
namespace {

using pipeline::ShaderGroup;
using pipeline::TableRecord;

constexpr uint64_t kBudget = 100'000'000;  // warp instructions
constexpr uint32_t kMaxTraceDepth = 8;     // the picture: four hits deep, each with a shadow ray below

enum Binding : uint32_t { kTopLevel, kImage, kVertices, kSpheres, kRays, kRecords };

rt::StructureInfo build_scene(const Recording& r, mem::AddressSpace& memory, const std::string& format) {
  const rt::BuildOptions options{format.c_str()};
  std::vector<rt::StructureInfo> bottoms;
  std::vector<rt::Bounds> boxes;
  for (const auto& s : r.spheres) {
    rt::Bounds box;
    for (size_t axis = 0; axis < 3; ++axis) box.low[axis] = s[axis] - s[3], box.high[axis] = s[axis] + s[3];
    boxes.push_back(box);
  }
  for (const auto& geometries : r.bottoms) {
    rt::BottomLevel level;
    for (const Geometry& g : geometries) {
      rt::Geometry geometry;
      geometry.opaque = g.opaque;
      geometry.no_duplicate_any_hit = true;
      geometry.stride = sizeof r.vertices[0];
      if (g.triangles)
        geometry.positions =
            std::as_bytes(std::span(r.vertices).subspan(g.first_vertex, size_t(g.count) * 3));
      else
        geometry.aabbs = std::span(boxes).first(g.count);
      level.geometries.push_back(geometry);
    }
    bottoms.push_back(rt::build_bottom(memory, "bottom level", level, options));
  }
  std::vector<rt::Instance> instances;
  for (const Instance& i : r.instances)
    instances.push_back({i.transform, i.custom, i.mask, i.sbt_offset, i.flags, i.bottom});
  return rt::build_top(memory, "top level", instances, bottoms, options);
}

// Holds memory, shaders and table of one launch. It cannot be moved, because the world points into it.
class Host {
 public:
  explicit Host(const Recording& r, const std::string& format = "bvh6") : recording_(r) {
    world.memory = &memory;
    world.constant_bank.resize(isa::kConstantBankBytes);
    world.max_trace_depth = kMaxTraceDepth;
    const rt::StructureInfo top = build_scene(r, memory, format);
    stack_need_ = top.stack_need;
    bind(kTopLevel, top.address, top.bytes);
    upload(kVertices, "vertices", r.vertices);
    upload(kSpheres, "spheres", r.spheres);
  }
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  exec::World world;
  mem::AddressSpace memory;
  pipeline::TableInput table;

  void bind(uint32_t binding, uint64_t address, uint64_t bytes) {
    const uint64_t descriptor[2] = {address, bytes};
    std::memcpy(world.constant_bank.data() + binding * isa::kDescriptorBytes, descriptor, sizeof descriptor);
  }
  template <class T>
  Address upload(uint32_t binding, const char* name, const std::vector<T>& values) {
    const Address at = memory.allocate(name, values.size() * sizeof(T));
    memory.write(at, values.data(), values.size() * sizeof(T));
    bind(binding, at, values.size() * sizeof(T));
    return at;
  }

  uint32_t shader(const std::string& file) {
    const auto [it, is_new] = shader_of_.emplace(file, uint32_t(programs_.size()));
    if (is_new) {
      Diagnostics diagnostics;
      frontend::GlslOptions glsl;
      glsl.cache = test::kept_shaders();
      programs_.push_back(
          frontend::compile_file((recording_.folder / "shaders" / file).string(), glsl, {}, diagnostics));
      isa::verify(programs_.back(), diagnostics);
      diagnostics.throw_if_errors();
    }
    return it->second;
  }
  uint32_t general(const std::string& file) {
    table.groups.push_back({shader(file), {}});
    return uint32_t(table.groups.size() - 1);
  }
  uint32_t hit_group(const std::string& closest, const std::string& any, const std::string& intersection) {
    const auto or_none = [&](const std::string& file) {
      return file.empty() ? exec::kNoShader : shader(file);
    };
    table.groups.push_back({exec::kNoShader, {or_none(closest), or_none(any), or_none(intersection)}});
    return uint32_t(table.groups.size() - 1);
  }
  // Sets hit records. Records 3 and 8 are of the instance with spheres.
  void hit_records(uint32_t triangles, uint32_t spheres, const std::vector<RecordData>& data) {
    for (size_t i = 0; i < data.size(); ++i) {
      TableRecord record{i % 5 == 3 ? spheres : triangles, std::vector<std::byte>(sizeof data[i])};
      std::memcpy(record.data.data(), &data[i], sizeof data[i]);
      table.hit.records.push_back(std::move(record));
    }
  }

  void run(bool timing, bool software = false) {
    pipeline::GpuParams gpu;
    gpu.cores = 2;
    gpu.rt.unit = software ? rt::kSoftware : rt::kHardware;
    pipeline::add_traversal(programs_, gpu, test::kept_shaders());
    image_ = exec::link(programs_);
    world.image = &image_;
    pipeline::build_binding_table(world, memory, table);
    world.local_bytes = pipeline::stack_bytes(image_, world.max_trace_depth, world.max_callable_depth);
    pipeline::place_records(world, stack_need_);
    if (timing) {
      pipeline::TimingMachine(gpu, world, false).run({});
    } else {
      pipeline::run_functional(world, kBudget, {});
    }
  }

 private:
  const Recording& recording_;
  uint32_t stack_need_ = 0;
  std::vector<isa::Program> programs_;
  std::map<std::string, uint32_t> shader_of_;
  exec::Image image_;
};

TableRecord callable_record(uint32_t group, uint32_t tag) {
  RecordData data{tag, 0, 0, 0, {}};
  TableRecord record{group, std::vector<std::byte>(sizeof data)};
  std::memcpy(record.data.data(), &data, sizeof data);
  return record;
}

}  // namespace

const std::vector<RecordData>& hit_records() {
  // These are tags and bases from the records: the tag of each hit, and the normals of each triangle. Alpha
  // is known from the hits that are missing where any-hit shaders run. The colours are the only ones that
  // give the picture (a linear system in which each pixel is one equation).
  static const std::vector<RecordData> kRecords = [] {
    std::vector<RecordData> records;
    const uint32_t bases[5] = {0, 360, 600, 0, 1464};
    const std::array<float, 4> colors[5] = {{0.9f, 0.3f, 0.2f, 1},
                                            {0.2f, 0.8f, 0.3f, 1},
                                            {0.3f, 0.4f, 0.9f, 1},
                                            {0.9f, 0.8f, 0.2f, 1},
                                            {0.6f, 0.6f, 0.6f, 1}};
    for (uint32_t i = 0; i < 10; ++i)
      records.push_back(
          {(i < 5 ? 1000u : 2000u) + i % 5, bases[i % 5], i == 0 || i == 7 ? 1u : 0u, 0, colors[i % 5]});
    return records;
  }();
  return kRecords;
}

std::vector<Record> run_mode(const Recording& r, const Mode& mode, const std::string& any_hit, bool timing,
                             const std::string& format, bool software) {
  Host host(r, format);
  host.world.any_hit = Registry<rt::AnyHitMode>::instance().entry(any_hit).make_default({});
  host.table.raygen = {host.general("rec.rgen"), {}};
  host.table.miss.records = {{host.general("rec.rmiss"), {}}, {host.general("rec2.rmiss"), {}}};
  const uint32_t triangles = host.hit_group("rec_tri.rchit", "tri.rahit", "");
  const uint32_t spheres = host.hit_group("rec_sph.rchit", "sph.rahit", "sph.rint");
  host.hit_records(triangles, spheres, hit_records());
  host.table.callable.records = {callable_record(host.general("c0.rcall"), 3000),
                                 callable_record(host.general("c1.rcall"), 3001)};
  // A set may hold later rays of a launch. The rays before them are launched, too, and not looked at.
  const uint32_t first = r.first_launch_index, count = first + r.rays_per_pattern;
  std::vector<Ray> rays(first, r.rays.front());
  rays.insert(rays.end(), r.rays.begin(), r.rays.end());
  host.upload(kRays, "rays", rays);
  const Address out = host.upload(kRecords, "records", std::vector<Record>(count));
  const uint32_t push[10] = {mode.ray_flags,
                             mode.mask,
                             mode.sbt_offset,
                             mode.sbt_stride,
                             mode.miss_index,
                             mode.any_hit_mode,
                             mode.pattern * r.rays_per_pattern,
                             0,
                             mode.callable,
                             0};
  std::memcpy(host.world.constant_bank.data() + isa::kPushConstantOffset, push, sizeof push);
  host.world.launch_size = {count, 1, 1};
  host.run(timing, software);
  const auto records = host.memory.view<Record>(out, count);
  return {records.begin() + first, records.end()};
}

std::vector<float> run_image(const Recording& r, uint32_t size, const std::vector<RecordData>& records) {
  Host host(r);
  host.table.raygen = {host.general("img.rgen"), {}};
  host.table.miss.records = {{host.general("img.rmiss"), {}}, {host.general("shadow.rmiss"), {}}};
  host.hit_records(host.hit_group("img_tri.rchit", "img_tri.rahit", ""),
                   host.hit_group("img_sph.rchit", "", "sph.rint"), records);
  const Address texels = host.memory.allocate("picture", uint64_t(size) * size * 16);
  host.world.images.push_back({exec::ImageView::Format::Rgba32Float, size, size, texels, "picture"});
  host.bind(kImage, 0, 1);
  host.world.launch_size = {size, size, 1};
  host.run(false);
  const auto view = host.memory.view<float>(texels, uint64_t(size) * size * 4);
  return {view.begin(), view.end()};
}

}  // namespace glint::vulkan_rt
