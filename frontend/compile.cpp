// Compiles a shader file to a program, and tells which stage a file name means.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/compile.h"

#include <filesystem>

#include "frontend/cache.h"
#include "frontend/pass_times.h"
#include "frontend/program_bytes.h"
#include "frontend/spirv/specialize.h"

namespace glint::frontend {
namespace {

// The name of a module is in its program once, so it is not in the key: applications make the same module
// again under another name for each pipeline.
std::string key_of(const std::vector<uint32_t>& spirv, const std::string& entry_point,
                   const BackendOptions& options) {
  ByteWriter key;
  key.put(std::string("program"));
  key.put(entry_point);
  key.put(options.max_registers);
  key.put(options.schedule);
  key.put(options.contract);
  key.put(options.queries_call);
  key.put(options.guard_latency);
  key.put(options.like_an_assembler);
  key.put(options.reorder_calls);
  key.put(options.reorder_traces);
  key.put(spirv);
  return key.take();
}

std::optional<CompiledModule> find_program(ShaderCache& cache, const std::string& key,
                                           const std::string& name) {
  const std::optional<std::string> bytes = cache.find(key);
  if (!bytes) return std::nullopt;
  ByteReader in(*bytes);
  CompiledModule out;
  in.get(out.simplified);
  in.get(out.program);
  out.program.name = name;
  return in.is_good() ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace

std::optional<isa::Stage> stage_of_file(const std::string& path) {
  // "main.rgen.glsl" is a common form, too.
  const std::filesystem::path name(path);
  const std::string ending = (name.extension() == ".glsl" ? name.stem() : name).extension().string();
  if (ending == ".rgen") return isa::Stage::RayGeneration;
  if (ending == ".rint") return isa::Stage::Intersection;
  if (ending == ".rahit") return isa::Stage::AnyHit;
  if (ending == ".rchit") return isa::Stage::ClosestHit;
  if (ending == ".rmiss") return isa::Stage::Miss;
  if (ending == ".rcall") return isa::Stage::Callable;
  if (ending == ".comp") return isa::Stage::Compute;
  return std::nullopt;
}

CompiledModule compile_module(const std::vector<uint32_t>& spirv, const std::string& name,
                              const std::string& entry_point, const BackendOptions& options,
                              Diagnostics& warnings, ShaderCache* cache, Validity validity) {
  const std::string key = cache ? key_of(spirv, entry_point, options) : std::string();
  if (cache)
    if (std::optional<CompiledModule> found = find_program(*cache, key, name)) return std::move(*found);
  CompiledModule out;
  const size_t warnings_before = warnings.messages().size();
  out.simplified = simplify(spirv, name, warnings, validity);
  out.program = lower(out.simplified, name, options, entry_point);
  // A module with warnings is not stored, so that its next compilation gives the same warnings.
  if (cache && warnings.messages().size() == warnings_before) {
    ByteWriter bytes;
    bytes.put(out.simplified);
    bytes.put(out.program);
    cache->store(key, bytes.take());
  }
  return out;
}

std::vector<uint32_t> spirv_of_file(const std::string& path, const GlslOptions& glsl) {
  std::vector<uint32_t> spirv = is_spirv_file(path) ? read_spirv(path) : glsl_to_spirv(path, glsl);
  return glsl.specialization.empty() ? spirv : specialize(std::move(spirv), glsl.specialization);
}

Validity validity_of_file(const GlslOptions& glsl) {
  return glsl.specialization.empty() ? Validity::Known : Validity::Unknown;
}

isa::Program compile_file(const std::string& path, const GlslOptions& glsl, const BackendOptions& options,
                          Diagnostics& warnings) {
  return compile_module(spirv_of_file(path, glsl), path, glsl.entry_point, options, warnings, glsl.cache,
                        validity_of_file(glsl))
      .program;
}

PassTimes time_compilation(const std::string& path, const GlslOptions& glsl, const BackendOptions& options,
                           Diagnostics& warnings) {
  PassTimes times;
  GlslOptions anew = glsl;
  anew.cache = nullptr;
  const std::vector<uint32_t> spirv = [&] {
    const PassTimer timer(&times, is_spirv_file(path) ? "reading" : "glslang", "");
    return spirv_of_file(path, anew);
  }();
  lower(simplify(spirv, path, warnings, validity_of_file(glsl), &times), path, options, glsl.entry_point,
        &times);
  return times;
}

}  // namespace glint::frontend
