// The whole way from a shader file to a program, and which stage a file name means.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/compile.h"

#include <filesystem>

#include "frontend/specialize.h"

namespace glint::frontend {

std::optional<isa::Stage> stage_of_file(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".rgen") return isa::Stage::RayGeneration;
  if (ending == ".rint") return isa::Stage::Intersection;
  if (ending == ".rahit") return isa::Stage::AnyHit;
  if (ending == ".rchit") return isa::Stage::ClosestHit;
  if (ending == ".rmiss") return isa::Stage::Miss;
  if (ending == ".rcall") return isa::Stage::Callable;
  if (ending == ".comp") return isa::Stage::Compute;
  return std::nullopt;
}

isa::Program compile_file(const std::string& path, const GlslOptions& glsl, const BackendOptions& options,
                          Diagnostics& warnings) {
  std::vector<uint32_t> spirv = is_spirv_file(path) ? read_spirv(path) : glsl_to_spirv(path, glsl);
  if (!glsl.specialization.empty()) spirv = specialize(std::move(spirv), glsl.specialization);
  return lower(simplify(std::move(spirv), path, warnings), path, options, glsl.entry_point);
}

}  // namespace glint::frontend
