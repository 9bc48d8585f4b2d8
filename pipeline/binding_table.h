// Builds the shader binding table as a Vulkan host fills it: records of handle and data, in strided regions.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/diagnostics.h"
#include "exec/image.h"

namespace glint::pipeline {

inline constexpr uint32_t kNoGroup = 0xffff'ffff;

// These are shaderGroupHandleAlignment, shaderGroupBaseAlignment and maxShaderGroupStride of the driver that
// the conformance set was recorded with.
inline constexpr uint32_t kHandleAlignment = 32, kBaseAlignment = 64, kMaxStride = 4096;

// Corresponds to VkRayTracingShaderGroupCreateInfoKHR: it holds indices into Image::shaders, or
// exec::kNoShader. A general group has a ray generation, miss or callable shader; a hit group has the others.
struct ShaderGroup {
  uint32_t general = exec::kNoShader;
  exec::HitGroup hit;
};

struct TableRecord {
  // This is the index into TableInput::groups. kNoGroup stands for a handle of zeros, which calls nothing.
  uint32_t group = kNoGroup;
  std::vector<std::byte> data;  // what the shader's shaderRecordEXT block holds
};

struct TableRegion {
  std::vector<TableRecord> records;
  // These are the bytes from one record to the next. If the value is absent, the smallest stride that holds
  // every record is used. If it is 0, only the first record is used.
  std::optional<uint32_t> stride;
  SourceLocation where = {};  // what an error of the stride names, if there is a file
};

struct TableInput {
  std::vector<ShaderGroup> groups;
  TableRecord raygen;
  TableRegion miss, hit, callable;
};

// Writes the table into simulated memory and sets raygen, miss, hit, callable and table of the world, whose
// image is linked. Throws UserError for a group that does not exist or does not fit its region, and for a
// stride that Vulkan forbids or that is too small for a record's data.
void build_binding_table(exec::World& world, mem::AddressSpace& memory, const TableInput& input);

// Returns the stack of a lane: the deepest chain of frames (Vulkan 1.3, "Ray Tracing Pipeline Stack", with
// the depths given).
uint32_t stack_bytes(const exec::Image& image, uint32_t max_trace_depth, uint32_t max_callable_depth);

}  // namespace glint::pipeline
