// Declares `glint isa [OP]`, which prints the reference of the instruction set from its table.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <memory>

#include "apps/glint/options/command_line.h"
#include "apps/glint/options/output.h"
#include "apps/glint/session.h"
#include "isa/op_row.h"
#include "isa/paths.h"
#include "isa/reference.h"
#include "setup/config.h"
#include "setup/resources.h"

namespace glint::app {
namespace {

struct IsaOptions {
  std::string op, table, page;
  bool index = false, pages = false;
};

isa::PresetTimes times_of(const setup::Resources& resources, const std::string& preset) {
  isa::PresetTimes out{preset, {}};
  const auto units = setup::read_preset(resources, preset).core.units.by_unit();
  for (size_t i = 0; i < units.size(); ++i) out.unit[i] = {units[i].latency, units[i].interval};
  return out;
}

// Presets with a base are left out, because they hardly change times of ops.
std::vector<isa::PresetTimes> all_presets(const setup::Resources& resources) {
  std::vector<isa::PresetTimes> out;
  for (const std::string& name : setup::names_of_whole_presets(resources))
    out.push_back(times_of(resources, name));
  return out;
}

// Returns the times of the presets that load. It says on stderr why a preset does not load.
std::vector<isa::PresetTimes> sound_presets(const setup::Resources& resources) {
  std::vector<isa::PresetTimes> out;
  for (const std::string& name : setup::names_of_whole_presets(resources)) {
    try {
      out.push_back(times_of(resources, name));
    } catch (const Error& error) {
      fmt::print(stderr, "warning: preset '{}' is left out: {}\n", name, error.what());
    }
  }
  return out;
}

std::string text_of(const setup::Resources& resources, const IsaOptions& options) {
  if (!options.table.empty()) return isa::instruction_table(times_of(resources, options.table));
  if (!options.page.empty()) return isa::reference_page(options.page, all_presets(resources));
  if (options.index) return isa::reference_index(all_presets(resources));
  if (!options.op.empty()) return isa::describe_op(options.op, sound_presets(resources));
  if (!options.pages) return isa::list_ops();
  std::string names;
  for (const isa::Family& family : isa::families()) names += isa::page_name(family.name) + "\n";
  return names;
}

}  // namespace

void add_isa(Command app, Session& session) {
  auto options = std::make_shared<IsaOptions>();
  Command command = app.add_subcommand("isa", "Explain the instruction set or one op");
  Option op = command.add_option(
      "OP", options->op, "An op's full name, such as fma.rn.f32, or the beginning of one (default: all ops)");
  Option table = command.add_option("--table", options->table,
                                    "Print unit, latency and interval of every op in a preset, as CSV");
  Option page =
      command.add_option("--page", options->page, "Print the page of a family, as in docs/isa/FAMILY.md");
  Option index = command.add_flag("--index", options->index, "Print the index, as in docs/isa.md");
  Option pages = command.add_flag("--pages", options->pages, "Print the names of the families' pages");
  table.type_name("PRESET");
  page.type_name("FAMILY");
  exclude_each_other({op, table, page, index, pages});
  command.callback([&session, options] {
    session.action = [&session, options] {
      write_output("", text_of(session.resources, *options));
      return Exit::Ok;
    };
  });
}

}  // namespace glint::app
