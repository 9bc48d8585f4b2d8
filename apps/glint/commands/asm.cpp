// Declares `glint asm FILE`, which reads the ISA's text, verifies it and prints it again.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <memory>

#include "apps/glint/options/command_line.h"
#include "apps/glint/options/output.h"
#include "apps/glint/session.h"
#include "isa/text.h"
#include "isa/verify.h"
#include "setup/resources.h"

namespace glint::app {
namespace {

Exit assemble(const std::string& file, const std::string& output) {
  const isa::Program program = isa::parse(setup::read_file(file), file);
  Diagnostics diagnostics;
  isa::verify(program, diagnostics);
  diagnostics.throw_if_errors();
  write_output(output, isa::to_text(program));
  return Exit::Ok;
}

}  // namespace

void add_asm(Command app, Session& session) {
  struct Options {
    std::string file, output;
  };
  auto options = std::make_shared<Options>();
  Command command = app.add_subcommand("asm", "Assemble and verify a program in the ISA's text");
  command.add_option("FILE", options->file, "File to read, with text as 'glint compile' prints it")
      .required();
  command.add_option("-o,--output", options->output, "File to write to instead of stdout").type_name("FILE");
  command.callback([&session, options] {
    session.action = [options] { return assemble(options->file, options->output); };
  });
}

}  // namespace glint::app
