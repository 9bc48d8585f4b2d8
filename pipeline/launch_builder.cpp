// Writes descriptors, constants and records into the world of a launch.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/launch_builder.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <iterator>
#include <utility>

#include "exec/block.h"
#include "isa/descriptors.h"
#include "pipeline/launch_size.h"
#include "pipeline/software_traversal.h"

namespace glint::pipeline {
namespace {

template <class Resource>
void append(std::vector<Resource>& to, std::vector<Resource>&& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

LaunchBuilder::LaunchBuilder(const LinkedShaders& shaders, mem::AddressSpace& memory,
                             const exec::ImagePool* pool)
    : shaders_(shaders), memory_(memory) {
  shaders.give_to(world);
  world.memory = &memory;
  world.pool = pool;
  world.constant_bank.resize(isa::kConstantBankBytes);
}

BufferRange LaunchBuilder::unbound(BindingPlace place) {
  return {isa::unbound_address(place.first, place.second), 0};
}

BufferRange LaunchBuilder::null() {
  return {isa::kNullAddress, 0};
}

void LaunchBuilder::write(BindingPlace place, uint64_t address_or_handle, uint64_t bytes_or_count) {
  bound_.insert(place);
  write_descriptor(world, place, address_or_handle, bytes_or_count);
}

Address LaunchBuilder::allocate(std::string name, uint64_t bytes) {
  return allocations_.emplace_back(memory_.allocate(std::move(name), bytes));
}

void LaunchBuilder::bind_buffers(BindingPlace place, const std::vector<BufferRange>& elements) {
  static_assert(sizeof(BufferRange) == isa::kDescriptorBytes);
  const frontend::Binding* use = shaders_.declared_at(place);
  if (noted_) noted_->push_back({place, elements});
  if (elements.empty()) return;
  if (!use || !use->is_array) return write(place, elements[0].address, elements[0].bytes);
  std::vector<BufferRange> all = elements;
  if (all.size() < use->count) all.resize(use->count, unbound(place));
  const Address table = allocate(fmt::format("descriptors of set {} binding {}", place.first, place.second),
                                 all.size() * isa::kDescriptorBytes);
  memory_.write(table, all.data(), all.size() * isa::kDescriptorBytes);
  write(place, table, all.size());
}

void LaunchBuilder::bind_images(BindingPlace place, std::vector<exec::ImageView> elements) {
  const size_t count = elements.size();
  if (noted_) noted_->push_back({place, elements});
  write(place, world.num_images(), count);
  append(world.images, std::move(elements));
  mark_rest_unbound(world, shaders_.declared_at(place), count);
}

void LaunchBuilder::bind_samplers(BindingPlace place, std::vector<exec::Sampler> elements) {
  const size_t count = elements.size();
  if (noted_) noted_->push_back({place, elements});
  write(place, world.num_samplers(), count);
  append(world.samplers, std::move(elements));
  mark_rest_unbound(world, shaders_.declared_at(place), count);
}

void LaunchBuilder::bind_table(BindingPlace place, Address table, uint64_t count) {
  write(place, table, count);
}

void LaunchBuilder::bind_pool_images(BindingPlace place, uint64_t first, uint64_t count) {
  write(place, first, count);
}

void LaunchBuilder::bind_pool_samplers(BindingPlace place, uint64_t first, uint64_t count) {
  write(place, first, count);
}

void LaunchBuilder::set_push_constants(std::span<const std::byte> bytes, uint32_t offset,
                                       const SourceLocation& where) {
  const uint64_t room = isa::kConstantBankBytes - isa::kPushConstantOffset;
  if (offset + bytes.size() > room)
    throw UserError(where, fmt::format("{} bytes of push constants do not fit: there is room for {}",
                                       offset + bytes.size(), room));
  if (bytes.empty()) return;
  std::memcpy(world.constant_bank.data() + isa::kPushConstantOffset + offset, bytes.data(), bytes.size());
}

void LaunchBuilder::set_blocks(uint32_t shader, const std::array<uint32_t, 3>& groups,
                               const SourceLocation& where) {
  const isa::Program& program = shaders_.image().programs.at(shader);
  const auto& size = program.local_size;
  if (uint64_t{size[0]} * size[1] * size[2] > exec::kMaxBlockThreads)
    throw UserError(where, fmt::format("'{}' has blocks of {} x {} x {} threads, and at most {} are possible",
                                       program.name, size[0], size[1], size[2], exec::kMaxBlockThreads));
  check_launch_size(groups, size, where);
  world.raygen = shader;
  world.max_callable_depth = 0;
  world.local_bytes = stack_bytes(shaders_.image(), world.max_trace_depth, world.max_callable_depth);
  exec::set_blocks(world, groups, size, program.shared_bytes);
}

void LaunchBuilder::set_rays(const std::array<uint32_t, 3>& size, uint32_t max_trace_depth,
                             uint32_t max_callable_depth, const SourceLocation& where) {
  check_launch_size(size, {1, 1, 1}, where);
  world.launch_size = size;
  world.max_trace_depth = max_trace_depth;
  world.max_callable_depth = max_callable_depth;
  world.local_bytes = stack_bytes(shaders_.image(), max_trace_depth, max_callable_depth);
}

void LaunchBuilder::set_records(const TableInput& input) {
  build_binding_table(world, memory_, input);
  allocations_.push_back(world.table.raygen);
}

exec::World& LaunchBuilder::finish(uint32_t stack_need) {
  for (const auto& [place, binding] : shaders_.declared())
    if (!bound_.count(place)) mark_unbound(world, binding);
  place_records(world, stack_need);
  return world;
}

}  // namespace glint::pipeline
