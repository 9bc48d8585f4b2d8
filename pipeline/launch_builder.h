// Makes the world of a launch from what a host has set up: descriptors, constants, records and a size.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/diagnostics.h"
#include "pipeline/binding_table.h"
#include "pipeline/linked_shaders.h"

namespace glint::pipeline {

// Names the bytes that a descriptor of a buffer covers, or the address of an acceleration structure.
struct BufferRange {
  Address address = 0;
  uint64_t bytes = 0;
};

// Is what a launch was given for one binding.
struct BoundResources {
  BindingPlace place;
  std::variant<std::vector<BufferRange>, std::vector<exec::ImageView>, std::vector<exec::Sampler>> elements;
};

// Pipeline files, Amber scripts and the Vulkan driver build their launches with this class:
//
//   const LinkedShaders shaders({stage.program}, stage.reflection.bindings, gpu, cache);  // once a pipeline
//
//   LaunchBuilder builder(shaders, memory, &pool);                                        // once a launch
//   builder.bind_buffers({0, 0}, {{address, bytes}});          // all elements of a binding at once
//   builder.bind_pool_images({0, 1}, first_number, count);     // views that stand in the pool already
//   builder.bind_samplers({0, 2}, {sampler});
//   builder.set_push_constants(bytes);
//   builder.set_blocks(0, {8, 8, 1});                          // or set_rays() and set_records()
//   builder.world.on_fault = exec::OnFault::Warn;              // anything else that a world says
//   const exec::World& world = builder.finish();
//   run_world(world, gpu, ...);
//   for (Address at : builder.allocations()) memory.free(at);  // where memory is used again
//
// The shaders, the memory and the pool outlive the world, which lives in the builder and may be moved out of
// it. Resources are host state: the caller places buffers and texels in memory and keeps them between
// launches. A pool lets a host write a descriptor set with thousands of images once, where launches take it
// by number and copy nothing.
class LaunchBuilder {
 public:
  LaunchBuilder(const LinkedShaders& shaders, mem::AddressSpace& memory,
                const exec::ImagePool* pool = nullptr);
  LaunchBuilder(const LaunchBuilder&) = delete;
  LaunchBuilder& operator=(const LaunchBuilder&) = delete;

  exec::World world;

  // Returns the range of an element that nobody wrote. Its use is a fault that names the place.
  static BufferRange unbound(BindingPlace place);
  // Returns the range of a buffer that the host has left out on purpose: loads give 0, and stores are
  // dropped. An acceleration structure is left out with address 0.
  static BufferRange null();

  // Bind all elements of a binding, in order; missing ones up to the shaders' count are unbound. A place that
  // no shader declares may be bound. Where the shaders declare an array of buffers or structures, the
  // elements go into a table in memory (docs/abi.md).
  void bind_buffers(BindingPlace place, const std::vector<BufferRange>& elements);
  void bind_images(BindingPlace place, std::vector<exec::ImageView> elements);
  void bind_samplers(BindingPlace place, std::vector<exec::Sampler> elements);
  // Lets the functions above note what they bind, in their order. A capsule is made of it.
  void note_bindings(std::vector<BoundResources>& into) { noted_ = &into; }
  // Bind what stands elsewhere already: a table of `count` descriptors at `table`, for a binding that the
  // shaders declare as an array, or consecutive images or samplers of the pool from number `first` on.
  void bind_table(BindingPlace place, Address table, uint64_t count);
  void bind_pool_images(BindingPlace place, uint64_t first, uint64_t count);
  void bind_pool_samplers(BindingPlace place, uint64_t first, uint64_t count);

  // Writes push constants from byte `offset` on. Throws UserError when they do not fit.
  void set_push_constants(std::span<const std::byte> bytes, uint32_t offset = 0,
                          const SourceLocation& where = {});

  // Makes it a launch of a compute shader, in `groups` blocks of the size that the shader's program has.
  // Throws UserError when a block or the launch has too many threads.
  void set_blocks(uint32_t shader, const std::array<uint32_t, 3>& groups, const SourceLocation& where = {});
  // Makes it a launch of rays. Throws UserError when it has too many threads.
  void set_rays(const std::array<uint32_t, 3>& size, uint32_t max_trace_depth, uint32_t max_callable_depth,
                const SourceLocation& where = {});
  // Writes the binding table into memory. Throws UserError as build_binding_table() does.
  void set_records(const TableInput& input);

  // Completes the world: what the shaders declare and nobody bound is a fault when it is used. `stack_need`
  // is the largest rt::StructureInfo::stack_need of the structures that the launch may meet.
  exec::World& finish(uint32_t stack_need = 0);

  // Returns what the builder has allocated, which nobody needs after the launch.
  const std::vector<Address>& allocations() const { return allocations_; }

 private:
  void write(BindingPlace place, uint64_t address_or_handle, uint64_t bytes_or_count);
  Address allocate(std::string name, uint64_t bytes);

  const LinkedShaders& shaders_;
  mem::AddressSpace& memory_;
  std::set<BindingPlace> bound_;
  std::vector<Address> allocations_;
  std::vector<BoundResources>* noted_ = nullptr;
};

}  // namespace glint::pipeline
