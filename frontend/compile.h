// Declares the frontend's public interface: GLSL or SPIR-V in, isa::Program out.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
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
  ShaderCache* cache = nullptr;                      // null: everything is compiled anew
};

struct BackendOptions {
  uint32_t max_registers = 64;  // 32-bit registers per thread; values beyond them spill to local memory
  bool schedule = true;         // latency-aware list scheduling
  bool contract = false;        // a * b + c becomes one fma where GLSL does not say `precise`
  // With true, rq.proceed is a call that preserves no register, because rays are traversed in shader code.
  bool queries_call = false;
  // These are the extra cycles that the scheduler assumes before a predicate can guard an instruction. With
  // more of them it places the comparisons for branches earlier.
  uint32_t guard_latency = 0;
  // These emit an instruction where a core may regroup lanes: at the shader's own calls, and before the hit
  // shaders of each trace. Without them a shader's call of reorderThread is nothing.
  bool reorder_calls = false, reorder_traces = false;
  // With true, the backend does as the assembler of the hardware. The scheduler moves nothing across an op
  // that ends in a call for rare operands (backend/slow_paths.h), and it keeps a run of instructions within
  // few registers, where the run fits (backend/schedule.h). Selections get guards up to the assembler's
  // lengths (backend/if_convert.h, backend/guarded_results.h).
  bool like_an_assembler = false;
};

// Returns the stage that the file's ending names: .rgen .rint .rahit .rchit .rmiss .rcall .comp, each also
// with .glsl after it. Returns nothing when the ending is unknown.
std::optional<isa::Stage> stage_of_file(const std::string& path);

// Runs glslang in process. Returns validated SPIR-V 1.6 words with OpLine debug information. Throws UserError
// with glslang's messages, each with file and line.
std::vector<uint32_t> glsl_to_spirv(const std::string& path, const GlslOptions& options);
// Does the same as glsl_to_spirv() for a text without a file of its own. `path` is used in messages and to
// find includes.
std::vector<uint32_t> glsl_text_to_spirv(const std::string& text, const std::string& path, isa::Stage stage,
                                         const GlslOptions& options);

// Reads a module in SPIR-V's binary form (.spv) or as text (.spvasm) and validates it. Throws UserError with
// the file.
std::vector<uint32_t> read_spirv(const std::string& path);
bool is_spirv_file(const std::string& path);

// Says whether a module is known to be valid, because it is as glsl_to_spirv() or read_spirv() returned it.
enum class Validity : uint8_t { Unknown, Known };

// Runs the pass list R1 of spirv/simplify.cpp (inline all, scalarise, SSA), with validation after it, and
// before it unless the module is known to be valid. When the optimiser fails, `warnings` gets its messages
// and the module is returned unchanged.
std::vector<uint32_t> simplify(std::vector<uint32_t> spirv, const std::string& name, Diagnostics& warnings,
                               Validity validity = Validity::Unknown);

// Returns SPIR-V text, for `glint compile --emit spirv`.
std::string disassemble_spirv(const std::vector<uint32_t>& words);

// Lowers one simplified module to a program. Throws one UnsupportedError that lists everything unsupported:
// op, file, line.
isa::Program lower(const std::vector<uint32_t>& spirv, const std::string& name, const BackendOptions& options,
                   const std::string& entry_point = {});

// Holds the results of simplify() and lower(). compile_module() takes them from `cache` when it can.
struct CompiledModule {
  std::vector<uint32_t> simplified;
  isa::Program program;
};
CompiledModule compile_module(const std::vector<uint32_t>& spirv, const std::string& name,
                              const std::string& entry_point, const BackendOptions& options,
                              Diagnostics& warnings, ShaderCache* cache,
                              Validity validity = Validity::Unknown);

// Returns the SPIR-V of a file, with its specialisation constants set. The file's ending says whether it is
// GLSL, .spv or .spvasm. The second function says whether the first one's result is known to be valid.
std::vector<uint32_t> spirv_of_file(const std::string& path, const GlslOptions& glsl);
Validity validity_of_file(const GlslOptions& glsl);
// Compiles one file with all of the steps above.
isa::Program compile_file(const std::string& path, const GlslOptions& glsl, const BackendOptions& options,
                          Diagnostics& warnings);

}  // namespace glint::frontend
