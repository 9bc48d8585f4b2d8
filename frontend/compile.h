// GLSL or SPIR-V in, isa::Program out: the frontend's public door.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "isa/program.h"

namespace glint::frontend {

class ShaderCache;

struct GlslOptions {
  std::vector<std::string> include_dirs;                     // -I
  std::vector<std::pair<std::string, std::string>> defines;  // -D NAME=VALUE
  std::string entry_point = {};                              // of a module with several; empty: the only one
  std::map<uint32_t, uint64_t> specialization = {};  // bits of specialisation constants, by constant_id
  ShaderCache* cache = nullptr;                      // none: everything is compiled anew
};

struct BackendOptions {
  uint32_t max_registers = 64;  // 32-bit registers a thread; fewer spill to local memory
  bool schedule = true;         // latency-aware list scheduling
  bool contract = false;        // a * b + c becomes one fma where GLSL does not say `precise`
  bool queries_call = false;    // rq.proceed is a call that keeps no register: rays are walked in code
  uint32_t guard_latency =
      0;  // cycles later that a predicate guards than it can be read: comparisons for branches come earlier
};

// Stage from the file's ending: .rgen .rint .rahit .rchit .rmiss .rcall .comp; empty when unknown.
std::optional<isa::Stage> stage_of_file(const std::string& path);

// Runs glslang in process. Returns SPIR-V 1.6 words with OpLine debug info, validated.
// UserError carries glslang's messages with file and line.
std::vector<uint32_t> glsl_to_spirv(const std::string& path, const GlslOptions& options);
// The same of a text that lies in no file of its own; `path` is for messages and for what it includes.
std::vector<uint32_t> glsl_text_to_spirv(const std::string& text, const std::string& path, isa::Stage stage,
                                         const GlslOptions& options);

// A module in SPIR-V's binary form (.spv) or text (.spvasm), validated. UserError with the file.
std::vector<uint32_t> read_spirv(const std::string& path);
bool is_spirv_file(const std::string& path);

// Pass list R1 (reference: docs/frontend.md): inline all, scalarise, SSA; validated before and after.
// When the optimiser fails, `warnings` hears of it and the module comes back as it was.
std::vector<uint32_t> simplify(std::vector<uint32_t> spirv, const std::string& name, Diagnostics& warnings);

// SPIR-V text, for `glint compile --emit spirv`.
std::string disassemble_spirv(const std::vector<uint32_t>& words);

// Lowers one simplified module to a program. UnsupportedError lists everything unsupported at once: op, file,
// line.
isa::Program lower(const std::vector<uint32_t>& spirv, const std::string& name, const BackendOptions& options,
                   const std::string& entry_point = {});

// simplify and lower, through `cache` if there is one.
struct CompiledModule {
  std::vector<uint32_t> simplified;
  isa::Program program;
};
CompiledModule compile_module(const std::vector<uint32_t>& spirv, const std::string& name,
                              const std::string& entry_point, const BackendOptions& options,
                              Diagnostics& warnings, ShaderCache* cache);

// SPIR-V of a file: GLSL, .spv or .spvasm by its ending; specialised.
std::vector<uint32_t> spirv_of_file(const std::string& path, const GlslOptions& glsl);
// All of the above for one file.
isa::Program compile_file(const std::string& path, const GlslOptions& glsl, const BackendOptions& options,
                          Diagnostics& warnings);

}  // namespace glint::frontend
