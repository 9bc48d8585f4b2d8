// All shaders of a pipeline linked into one code image, and the world they run in: what a warp executes against.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "isa/op_row.h"
#include "isa/program.h"
#include "isa/text.h"
#include "memsys/address_space.h"

namespace glint::core {

inline constexpr uint32_t kNoShader = 0xffff'ffff;

// One linked shader: where its code lies in Image::code.
struct Shader {
  std::string name;
  isa::Stage stage = isa::Stage::Compute;
  uint32_t entry = 0, end = 0;   // instruction indices [entry, end)
  uint32_t local_bytes = 0;
  isa::SpecialSet specials_used;
  bool uses_ray = false, uses_matrices = false;  // reads %payload to %world_to_object; %object.origin and on
};

// Code of all shaders, branch targets absolute, constants in one table of 32-lane rows.
struct Image {
  std::vector<isa::Inst> code;
  std::vector<const isa::OpRow*> rows;     // one an instruction: op_table()[code[i].op]
  std::vector<uint8_t> target_is_join;     // one an instruction: a branch here goes to a `join`
  std::vector<isa::Line> lines;            // one an instruction; file indexes Image::files
  std::vector<std::string> files;
  std::vector<uint32_t> shader_of;         // one an instruction
  std::vector<Shader> shaders;
  std::unique_ptr<uint32_t[], void (*)(void*)> constants{nullptr, nullptr};  // rows of kLanes, 64-byte aligned
  uint32_t num_registers = 1;              // highest of all shaders

  std::string place_of(uint32_t pc) const; // "shader.rchit:12 (instruction 87: fma.rn.f32)"
};
Image link(const std::vector<isa::Program>& programs);

// A hit group: indices into Image::shaders or kNoShader.
struct HitGroup {
  uint32_t closest_hit = kNoShader, any_hit = kNoShader, intersection = kNoShader;
};

// A sampled texture or storage image in simulated memory, linear rows.
struct ImageView {
  enum class Format : uint8_t { Rgba8Unorm, Rgba32Float } format = Format::Rgba32Float;
  uint32_t width = 1, height = 1;
  Address base = 0;
  std::string name;
};

// Everything a launch gives to its warps. Read-only while warps run (memory contents apart).
struct World {
  const Image* image = nullptr;
  mem::AddressSpace* memory = nullptr;
  std::vector<std::byte> constant_bank;    // kConstantBankBytes: descriptors and push constants (isa/program.h)
  std::vector<ImageView> images;           // texture and image handles index this
  uint32_t raygen = kNoShader;             // or the compute shader
  std::vector<uint32_t> miss;              // records of the binding table
  std::vector<HitGroup> hit;
  Address binding_table = 0;               // virtual address of the table's bytes: a call reads its 32 B record
  std::array<uint32_t, 3> launch_size{1, 1, 1};
  bool nearest_first_hit = true;           // rt::RayState::end_at_first_hit is its opposite
  uint32_t local_bytes = 0;                // stack a lane
  uint32_t max_trace_depth = 1;            // nested rt.trace (Vulkan's recursion depth)
};

}  // namespace glint::core
