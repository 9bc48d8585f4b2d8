// Makes the world of a launch that a capsule holds.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/capsule/capsule.h"
#include "pipeline/params.h"

namespace glint::pipeline {

// Holds memory, shaders and world of a capsule's launch on a GPU. Structures that were built for another node
// format are built anew. It cannot be moved, because the world points into it.
class CapsuleWorld {
 public:
  // Throws UserError when the capsule contradicts itself, cannot be compiled, or when a structure would have
  // to be built anew and what it was built from is not there.
  CapsuleWorld(const Capsule& capsule, const GpuParams& gpu, frontend::ShaderCache* cache);
  CapsuleWorld(const CapsuleWorld&) = delete;
  CapsuleWorld& operator=(const CapsuleWorld&) = delete;

  exec::World& world() { return builder_->world; }
  mem::AddressSpace& memory() { return memory_; }
  std::vector<std::string> notes;  // about structures that were built anew

 private:
  void compile(const GpuParams& gpu, frontend::ShaderCache* cache);
  void build_structures(const GpuParams& gpu);
  void build_structure(const PlacedStructure& structure, const rt::BuildOptions& options);
  void bind();
  void set_rays(const Capsule::Rays& rays);
  uint32_t stack_need() const;

  const Capsule& capsule_;
  mem::AddressSpace memory_;
  std::unique_ptr<const LinkedShaders> shaders_;
  std::unique_ptr<LaunchBuilder> builder_;
  std::map<Address, Address> moved_;  // structures that did not fit where they were
  bool is_rebuilt_ = false;
};

}  // namespace glint::pipeline
