// Describes a launch of an application with all that it can reach, so that it can run again alone.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/device_table.h"
#include "pipeline/launch_builder.h"
#include "rtunit/structure/in_memory.h"

namespace glint::pipeline {

// Holds what a structure was built from, so that it can be built in another node format.
struct StructureInputs {
  struct Geometry {
    std::vector<float> positions;  // three a corner
    std::vector<uint32_t> indices;
    std::vector<rt::Bounds> boxes;
    std::array<float, 12> transform = rt::kIdentity;
    bool opaque = true, no_duplicate_any_hit = false;
    std::optional<rt::Micromaps> micromaps;
  };
  bool is_top = false;
  std::vector<Geometry> geometries;           // of a bottom level
  std::vector<rt::DeviceInstance> instances;  // of a top level
};
// Copies the geometries of a bottom level.
std::shared_ptr<const StructureInputs> inputs_of(const rt::BottomLevel& level);

// Names a structure of an application: bytes of simulated memory, and what they were built from.
struct PlacedStructure {
  std::string name;
  Address address = 0;
  uint64_t room = 0;                              // bytes that it may take there
  std::shared_ptr<const StructureInputs> inputs;  // null: nobody knows, because it was deserialised
};

// Is simulated memory as far as it was taken along, in such a way that everything lies at the same virtual
// and physical addresses again.
struct SavedMemory {
  // Is a run of bytes that are not all 0.
  struct Bytes {
    uint64_t offset = 0;  // in its backing
    std::string bytes;
  };
  struct Backing {
    Address physical = 0;
    uint64_t bytes = 0;
    std::vector<Bytes> contents;
  };
  struct Window {
    uint64_t slot = 0;  // upper 32 bits of its addresses
    uint64_t backing = 0, offset = 0, bytes = 0;
  };
  struct Range {
    uint64_t first = 0, count = 0;
  };
  std::vector<Backing> backings;  // by physical address
  std::vector<Window> windows;    // by slot
  std::vector<Range> free;        // physical bytes before `end` that nobody had, by address
  Address end = 0;                // one past the last physical byte that somebody had
};

struct Capsule {
  struct Stage {
    std::string name, entry;
    uint32_t stage = 0;                      // isa::Stage
    std::map<uint32_t, uint64_t> constants;  // of specialisation
    std::vector<uint32_t> words;             // SPIR-V
  };
  struct Rays {
    std::vector<ShaderGroup> groups;
    uint64_t pipeline = 0;  // the number that handles hold
    DeviceTable table;
    uint32_t max_trace_depth = 1, default_callable_depth = 2, max_callable_depth = 31;
    std::optional<uint32_t> stack_bytes;  // that the application has set
    uint32_t added_flags = 0;             // exec::World::added_ray_flags
  };
  std::string program, label, kind, shader;       // what it was; `kind` is "dispatch" or "trace"
  uint64_t number = 0, frame = 0;                 // of the launch in the application
  uint64_t hash = 0;                              // of the launch's work, as in run.json
  std::string config;                             // the machine that the application ran on
  std::optional<uint64_t> cycles;                 // that it took there
  std::string structure_format;                   // keys of [bvh] with which its structures were built
  std::array<uint32_t, 3> size{1, 1, 1}, base{};  // blocks, or rays
  std::vector<Stage> stages;
  std::optional<Rays> rays;  // nothing: a dispatch
  std::vector<BoundResources> bindings;
  std::vector<std::byte> push_constants;
  bool robust_buffers = false, robust_images = false;
  bool has_micromaps = false;  // Rays ask the leaf filter that reads opacity micromaps.
  uint32_t stack_need = 0;     // stack entries that the worst ray needs in any structure of the application
  std::vector<PlacedStructure> structures;
  SavedMemory memory;
};

// Returns the keys that decide the bytes of structures, as text that can be compared.
std::string structure_format(const rt::BuildOptions& options);

}  // namespace glint::pipeline
