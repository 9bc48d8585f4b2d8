// `glint compile FILE...`: GLSL to SPIR-V text or to the ISA's text.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/compile.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <memory>

#include "apps/glint/resources.h"
#include "apps/glint/session.h"
#include "isa/text.h"

namespace glint::app {
namespace {

struct Options {
  std::vector<std::string> files, include_dirs, defines;
  std::string emit = "isa", output;
  uint32_t registers = frontend::BackendOptions{}.max_registers;
};

frontend::GlslOptions glsl_options(const Options& options) {
  frontend::GlslOptions glsl;
  glsl.include_dirs = options.include_dirs;
  for (const std::string& define : options.defines) {
    const size_t equals = define.find('=');
    const bool has_value = equals != std::string::npos;
    glsl.defines.emplace_back(define.substr(0, equals), has_value ? define.substr(equals + 1) : "1");
  }
  return glsl;
}

Exit compile(const Options& options) {
  const frontend::GlslOptions glsl = glsl_options(options);
  frontend::BackendOptions backend;
  backend.max_registers = options.registers;
  std::string out;
  Diagnostics warnings;
  for (const std::string& file : options.files) {
    if (options.emit == "spirv")
      out += frontend::disassemble_spirv(frontend::glsl_to_spirv(file, glsl));
    else
      out += isa::to_text(frontend::compile_file(file, glsl, backend, warnings));
  }
  for (const std::string& warning : warnings.messages()) fmt::print(stderr, "{}\n", warning);
  write_output(options.output, out);
  return Exit::Ok;
}

}  // namespace

void add_compile(CLI::App& app, Session& session) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("compile", "Compile GLSL shaders and print the result");
  command
      ->add_option("FILE", options->files,
                   "Shaders; the stage is the file's ending: .rgen .rchit .rmiss .rahit .rint .rcall .comp")
      ->required();
  command->add_option("--emit", options->emit, "What to print")
      ->check(CLI::IsMember({"spirv", "isa"}))
      ->capture_default_str();
  command->add_option("-I,--include", options->include_dirs, "Folder to look for #include in")
      ->type_name("DIR")
      ->allow_extra_args(false);
  command->add_option("-D,--define", options->defines, "Macro")
      ->type_name("NAME[=VALUE]")
      ->allow_extra_args(false);
  command->add_option("-o,--output", options->output, "File to write instead of stdout")->type_name("FILE");
  command->add_option("--registers", options->registers, "32-bit registers a thread before values spill")
      ->check(CLI::Range(16, 255))
      ->capture_default_str();
  command->callback([&session, options] { session.action = [options] { return compile(*options); }; });
}

}  // namespace glint::app
