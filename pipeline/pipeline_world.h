// Puts a described pipeline into simulated memory: links shaders, uploads resources, places records and
// constants.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/description/check.h"
#include "pipeline/launch_builder.h"
#include "pipeline/render.h"

namespace glint::pipeline {

// Holds the memory of a pipeline file and the worlds of its launches. They keep what they write there for
// each other. It cannot be moved, because the worlds point into it.
class PipelineWorld {
 public:
  // Reads meshes and pictures and builds structures on up to `threads` threads of the host, which show in
  // nothing. Throws UserError that lists what is wrong with the description, or UnsupportedError for what a
  // shader uses and Glint lacks.
  PipelineWorld(const PipelineDescription& description, const GpuParams& gpu, uint32_t threads = 1);
  PipelineWorld(const PipelineWorld&) = delete;
  PipelineWorld& operator=(const PipelineWorld&) = delete;

  size_t num_launches() const { return launches_.size(); }
  exec::World& world(size_t launch = 0) { return launches_[launch].builder->world; }
  const exec::World& world(size_t launch = 0) const { return launches_[launch].builder->world; }
  StructureCounts structures;
  std::vector<std::string> warnings;
  const Modules& modules() const { return modules_; }
  const PipelineDescription& description() const { return description_; }
  const mem::AddressSpace& memory() const { return memory_; }

  // Returns what a buffer or an image holds, by its number in the description.
  std::span<const std::byte> buffer(size_t index) const;
  const exec::ImageView& image(size_t index) const { return images_[index]; }

 private:
  // Holds a launch with the shaders that it uses. The other shaders of the file take no registers from it.
  struct Built {
    const LaunchDescription& description;
    std::vector<uint32_t> number;  // its number of each module, or exec::kNoShader
    std::unique_ptr<const LinkedShaders> shaders;
    std::unique_ptr<LaunchBuilder> builder;
  };
  void link(const LaunchDescription& launch, const GpuParams& gpu);
  bool uses(const LaunchDescription& launch, const ShaderModule& module) const;
  uint32_t number_of(const Built& launch, const std::string& shader) const;
  void set_size(const Built& launch);
  void upload_buffers();
  void upload_images(uint32_t threads);
  void add_samplers();
  void add_filter(const GpuParams& gpu);
  uint32_t build_structures(const GpuParams& gpu, uint32_t threads);
  void fill_records(const Built& launch);
  void set_push_constants(const Built& launch);
  const BindingUse* use_of(const Slot& slot) const;
  TableRecord record(const Built& launch, const RecordDescription& description, TableInput& input,
                     bool is_hit);
  uint32_t group_index(const Built& launch, const GroupDescription& group, TableInput& input, bool is_hit);
  uint64_t address_of(const std::string& buffer) const;

  const PipelineDescription description_;
  const Modules modules_;
  mem::AddressSpace memory_;
  std::vector<Built> launches_;
  std::vector<Address> buffer_address_;
  std::vector<uint64_t> buffer_bytes_;
  std::vector<exec::ImageView> images_;
  Diagnostics errors_;
};

}  // namespace glint::pipeline
