// `glint isa [OP]`: the reference of the instruction set, from its table.
// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>

#include "apps/glint/resources.h"
#include "apps/glint/session.h"
#include "isa/op_row.h"
#include "isa/reference.h"

namespace glint::app {
namespace {

Exit print_reference(const std::string& op) {
  write_output("", op.empty() ? isa::reference_markdown() : isa::describe_op(op));
  return Exit::Ok;
}

}  // namespace

void add_isa(CLI::App& app, Session& session) {
  auto op = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("isa", "Explain the instruction set, or one op");
  command->add_option("OP", *op, "An op's full name: fma.rn.f32 (default: all, as docs/isa.md)");
  command->callback([&session, op] { session.action = [op] { return print_reference(*op); }; });
}

}  // namespace glint::app
