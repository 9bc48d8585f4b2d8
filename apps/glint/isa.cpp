// `glint isa [OP]`: the reference of the instruction set, from its table.
// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>

#include "apps/glint/resources.h"
#include "apps/glint/session.h"
#include "isa/op_row.h"
#include "isa/reference.h"

namespace glint::app {
namespace {

Exit print_reference(const std::string& op) {
  if (op.empty()) {
    write_output("", isa::reference());
    return Exit::Ok;
  }
  if (const int index = isa::find_op(op); index >= 0) {
    write_output("", isa::reference_of(isa::op_table()[size_t(index)]));
    return Exit::Ok;
  }
  std::vector<std::string> names;
  for (const isa::OpRow& row : isa::op_table()) names.emplace_back(row.name);
  const std::string guess = nearest(op, names);
  throw UserError(
      {}, fmt::format("no op '{}'", op),
      guess.empty() ? "'glint list ops' names them all" : fmt::format("did you mean '{}'?", guess));
}

}  // namespace

void add_isa(CLI::App& app, Session& session) {
  auto op = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("isa", "Explain the instruction set, or one op");
  command->add_option("OP", *op, "An op's full name: fma.rn.f32 (default: all, as docs/isa.md)");
  command->callback([&session, op] { session.action = [op] { return print_reference(*op); }; });
}

}  // namespace glint::app
