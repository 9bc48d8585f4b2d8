// Lays out the records of the binding table: handle, data, stride, and what each record calls.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/binding_table.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <fmt/format.h>

#include "base/diagnostics.h"

namespace glint::pipeline {
namespace {

using exec::kHandleBytes;
using isa::Stage;

uint64_t round_up(uint64_t bytes, uint64_t to) {
  return (bytes + to - 1) / to * to;
}

class Table {
 public:
  Table(exec::World& world, const TableInput& input) : world_(world), input_(input) {}

  void build(mem::AddressSpace& memory) {
    const TableRegion raygen{{input_.raygen}, {}};
    world_.raygen = general(input_.raygen, "the ray generation record", Stage::RayGeneration);
    place(raygen, "ray generation");
    const uint64_t miss = place(input_.miss, "miss"), hit = place(input_.hit, "hit"),
                   callable = place(input_.callable, "callable");
    const Address base = memory.allocate("shader binding table", bytes_.size());
    memory.write(base, bytes_.data(), bytes_.size());
    world_.table = {base,
                    {base + miss, stride(input_.miss, "miss")},
                    {base + hit, stride(input_.hit, "hit")},
                    {base + callable, stride(input_.callable, "callable")}};
    world_.miss = generals(input_.miss, "miss", Stage::Miss);
    world_.callable = generals(input_.callable, "callable", Stage::Callable);
    world_.hit.clear();
    for (size_t i = 0; i < input_.hit.records.size(); ++i)
      world_.hit.push_back(hit_group(input_.hit.records[i], fmt::format("hit record {}", i)));
  }

 private:
  uint32_t stride(const TableRegion& region, const char* name) const {
    uint64_t largest = 0;
    for (const TableRecord& record : region.records)
      largest = std::max<uint64_t>(largest, record.data.size());
    const uint64_t need = round_up(kHandleBytes + largest, kHandleAlignment);
    if (need > kMaxStride)
      throw UserError(region.where,
                      fmt::format("a {} record has {} bytes, and with its handle at most {} fit", name,
                                  largest, kMaxStride));
    if (!region.stride) return uint32_t(need);
    if (*region.stride % kHandleAlignment || *region.stride > kMaxStride)
      throw UserError(
          region.where,
          fmt::format("the stride of the {} region is {}: it must be a multiple of {} and at most {}", name,
                      *region.stride, kHandleAlignment, kMaxStride));
    if (*region.stride != 0 && region.records.size() > 1 && *region.stride < need)
      throw UserError(region.where,
                      fmt::format("the stride of the {} region is {}, and its largest record needs {}", name,
                                  *region.stride, need));
    return *region.stride;
  }

  // Appends the records and returns where they begin.
  uint64_t place(const TableRegion& region, const char* name) {
    const uint64_t first = round_up(bytes_.size(), kBaseAlignment);
    const uint64_t step = stride(region, name);
    for (size_t i = 0; i < (step ? region.records.size() : std::min<size_t>(1, region.records.size())); ++i) {
      const TableRecord& record = region.records[i];
      const uint64_t at = first + i * step;
      bytes_.resize(std::max<uint64_t>(bytes_.size(),
                                       at + std::max<uint64_t>(step, kHandleBytes + record.data.size())));
      const uint32_t handle = record.group == kNoGroup ? 0 : record.group + 1;
      std::memcpy(bytes_.data() + at, &handle, sizeof handle);
      if (!record.data.empty())
        std::memcpy(bytes_.data() + at + kHandleBytes, record.data.data(), record.data.size());
    }
    return first;
  }

  const ShaderGroup& group(const TableRecord& record, const std::string& where) const {
    if (record.group >= input_.groups.size())
      throw UserError(
          fmt::format("{} names group {}, and there are {}", where, record.group, input_.groups.size()));
    return input_.groups[record.group];
  }

  void check(uint32_t shader, Stage stage, const std::string& where) const {
    if (shader == exec::kNoShader) return;
    if (shader >= world_.image->shaders.size())
      throw UserError(
          fmt::format("{} names shader {}, and there are {}", where, shader, world_.image->shaders.size()));
    const exec::Shader& found = world_.image->shaders[shader];
    if (found.stage != stage)
      throw UserError(fmt::format("{} wants a shader of stage {}, and '{}' is of stage {}", where,
                                  isa::name_of(stage), found.name, isa::name_of(found.stage)));
  }

  uint32_t general(const TableRecord& record, const std::string& where, Stage stage) const {
    if (record.group == kNoGroup) return exec::kNoShader;
    const ShaderGroup& found = group(record, where);
    if (found.general == exec::kNoShader)
      throw UserError(fmt::format("{} names group {}, which is a hit group", where, record.group));
    check(found.general, stage, where);
    return found.general;
  }

  std::vector<uint32_t> generals(const TableRegion& region, const char* name, Stage stage) const {
    std::vector<uint32_t> out;
    for (size_t i = 0; i < region.records.size(); ++i)
      out.push_back(general(region.records[i], fmt::format("{} record {}", name, i), stage));
    return out;
  }

  exec::HitGroup hit_group(const TableRecord& record, const std::string& where) const {
    if (record.group == kNoGroup) return {};
    const ShaderGroup& found = group(record, where);
    if (found.general != exec::kNoShader)
      throw UserError(fmt::format("{} names group {}, which is not a hit group", where, record.group));
    check(found.hit.closest_hit, Stage::ClosestHit, where);
    check(found.hit.any_hit, Stage::AnyHit, where);
    check(found.hit.intersection, Stage::Intersection, where);
    return found.hit;
  }

  exec::World& world_;
  const TableInput& input_;
  std::vector<std::byte> bytes_;
};

}  // namespace

void build_binding_table(exec::World& world, mem::AddressSpace& memory, const TableInput& input) {
  Table(world, input).build(memory);
}

uint32_t stack_bytes(const exec::Image& image, uint32_t max_trace_depth, uint32_t max_callable_depth) {
  uint64_t largest[size_t(isa::kNumStages)] = {};
  for (const exec::Shader& shader : image.shaders) {
    uint64_t& bytes = largest[size_t(shader.stage)];
    bytes = std::max<uint64_t>(bytes, shader.local_bytes);
  }
  const auto of = [&](Stage stage) { return largest[size_t(stage)]; };
  const uint64_t tracing = std::max(of(Stage::ClosestHit), of(Stage::Miss));
  const uint64_t innermost = std::max(tracing, of(Stage::Intersection) + of(Stage::AnyHit));
  const uint64_t rays = max_trace_depth == 0 ? 0 : innermost + (max_trace_depth - 1) * tracing;
  return uint32_t(round_up(
      of(Stage::RayGeneration) + of(Stage::Compute) + rays + max_callable_depth * of(Stage::Callable), 16));
}

}  // namespace glint::pipeline
