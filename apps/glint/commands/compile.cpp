// Declares `glint compile FILE...`, which compiles GLSL or SPIR-V to SPIR-V words, SPIR-V text or the ISA's
// text.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/compile.h"

#include <cstdio>
#include <fmt/format.h>
#include <memory>

#include "apps/glint/options/output.h"
#include "apps/glint/options/shader_options.h"
#include "apps/glint/session.h"
#include "frontend/pass_times.h"
#include "frontend/spirv/inline_scopes.h"
#include "isa/text.h"

namespace glint::app {
namespace {

struct CompileOptions {
  std::vector<std::string> files;
  std::string emit = "isa", output, entry_point;
  bool time = false;
  ShaderOptions shaders;
  frontend::BackendOptions backend;
};

// Returns a table of stages and passes, with the time of the optimiser's passes below that of the optimiser.
std::string times_of(const CompileOptions& options, const std::string& file,
                     const frontend::GlslOptions& glsl, Diagnostics& warnings) {
  const frontend::PassTimes times = frontend::time_compilation(file, glsl, options.backend, warnings);
  std::string out = fmt::format("{}\n{:<12} {:<36} {:>10}\n", file, "stage", "pass", "seconds");
  for (const frontend::PassTime& row : times)
    out += fmt::format("{:<12} {:<36} {:>10.3f}\n", row.stage, row.pass, row.seconds);
  return out;
}

std::string text_of(const CompileOptions& options, const std::string& file, const frontend::GlslOptions& glsl,
                    Diagnostics& warnings) {
  if (options.emit == "isa")
    return isa::to_text(frontend::compile_file(file, glsl, options.backend, warnings));
  std::vector<uint32_t> words = frontend::spirv_of_file(file, glsl);
  if (options.emit == "simplified")
    words = frontend::simplify(std::move(words), file, warnings, frontend::validity_of_file(glsl));
  if (options.emit == "spv")
    return {reinterpret_cast<const char*>(words.data()), words.size() * sizeof words[0]};
  return frontend::disassemble_spirv(frontend::with_plain_lines(words));
}

Exit compile(const CompileOptions& options) {
  if (options.emit == "spv" && options.files.size() > 1)
    throw UserError({}, "--emit spv writes one module, and there are several files");
  const std::unique_ptr<frontend::ShaderCache> cache = open_shader_cache(options.shaders);
  frontend::GlslOptions glsl = glsl_options(options.shaders, cache.get());
  glsl.entry_point = options.entry_point;
  std::string out;
  Diagnostics warnings;
  for (const std::string& file : options.files)
    out += options.time ? times_of(options, file, glsl, warnings) : text_of(options, file, glsl, warnings);
  for (const std::string& warning : warnings.messages()) fmt::print(stderr, "{}\n", warning);
  write_output(options.output, out);
  return Exit::Ok;
}

}  // namespace

void add_compile(Command app, Session& session) {
  auto options = std::make_shared<CompileOptions>();
  Command command = app.add_subcommand("compile", "Compile shaders from GLSL or SPIR-V and print the result");
  command
      .add_option("FILE", options->files,
                  "Shaders to compile; the file's ending gives the stage: .rgen .rchit .rmiss .rahit .rint "
                  ".rcall .comp; .spv and .spvasm are SPIR-V")
      .required();
  command
      .add_option("--emit", options->emit,
                  "Selects what is printed: the ISA's text (isa), SPIR-V as text (spvasm; spirv is the "
                  "same), SPIR-V as words (spv), or SPIR-V as it is lowered (simplified)")
      .one_of({"isa", "spvasm", "spirv", "spv", "simplified"})
      .capture_default_str();
  command.add_option("--entry", options->entry_point, "Entry point to use in a module with several")
      .type_name("NAME");
  command.add_flag("--time", options->time,
                   "Print the processor time of every stage and pass instead of the result; nothing is taken "
                   "from the cache");
  add_shader_options(command, options->shaders);
  command.add_option("-o,--output", options->output, "File to write to instead of stdout").type_name("FILE");
  command
      .add_option("--registers", options->backend.max_registers,
                  "Number of 32-bit registers per thread; values beyond them spill to local memory")
      .in_range(16, 255)
      .capture_default_str();
  command.callback([&session, options] {
    options->backend.contract = options->shaders.contract;
    session.action = [options] { return compile(*options); };
  });
}

}  // namespace glint::app
