// Declares `glint list WHAT`: scenes, materials, shaders, workloads, programs, configs, policies, oracles,
// ops, stats, metrics.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <memory>

#include "apps/glint/bench/workloads.h"
#include "apps/glint/options/command_line.h"
#include "apps/glint/options/config.h"
#include "apps/glint/options/output.h"
#include "apps/glint/options/stat_list.h"
#include "apps/glint/session.h"
#include "base/registry.h"
#include "compute/program.h"
#include "isa/op_row.h"
#include "isa/op_tests.h"
#include "report/metrics/metrics.h"
#include "report/metrics/vulkan_sim.h"
#include "report/terminal/table.h"
#include "scenes/overrides.h"
#include "scenes/scene.h"
#include "setup/oracles.h"
#include "setup/resources.h"

namespace glint::app {
namespace {

using Rows = std::vector<std::vector<std::string>>;

Rows scene_rows() {
  Rows rows;
  for (const scenes::SceneInfo& info : scenes::scene_list()) rows.push_back({info.name, info.doc});
  return rows;
}

Rows shader_rows() {
  Rows rows;
  for (const WorkloadInfo& info : kWorkloads) rows.push_back({std::string(info.name), std::string(info.doc)});
  return rows;
}

Rows workload_rows() {
  Rows rows;
  for (const NamedWorkload& workload : lumibench())
    rows.push_back({workload.name(), std::string(workload.scene), std::string(workload.shader),
                    workload.in_subset ? "subset" : ""});
  for (const NamedWorkload& workload : lumibench_motion())
    rows.push_back({workload.name(), std::string(workload.scene), std::string(workload.shader),
                    fmt::format("lumibench-motion, frames {}", workload.frames)});
  return rows;
}

Rows program_rows() {
  Rows rows;
  for (const compute::Program& program : compute::all_programs())
    rows.push_back({std::string(program.name), std::string(program.doc), std::string(program.full_input),
                    std::string(program.small_input)});
  return rows;
}

std::string metrics_page() {
  return report::metrics_markdown() +
         "\n## Vulkan-Sim's names\n\n`glint stats RUN --format vulkan-sim` prints them.\n\n" +
         report::vulkan_sim_markdown();
}

Rows metric_rows() {
  Rows rows;
  for (const report::MetricGroup& group : report::metric_groups())
    for (const report::Metric& metric : group.metrics)
      rows.push_back({std::string(metric.name), std::string(metric.unit), std::string(metric.doc)});
  return rows;
}

// Returns the presets. The first comment line of a preset says what it is.
Rows config_rows(const setup::Resources& resources) {
  Rows rows;
  for (const std::string& name : resources.config_names()) {
    const std::string text = setup::read_file(resources.config_path(name));
    const bool comment = text.rfind("# ", 0) == 0;
    rows.push_back({name, comment ? text.substr(2, text.find('\n') - 2) : ""});
  }
  return rows;
}

Rows policy_rows() {
  Rows rows;
  for (const PolicyInfo& info : all_policies())
    rows.push_back({std::string(info.kind.folder), std::string(info.kind.key), info.name, info.doc});
  return rows;
}

Rows oracle_rows() {
  Rows rows;
  for (const auto& [name, doc] : setup::oracle_list()) rows.push_back({name, doc});
  return rows;
}

Rows op_rows() {
  Rows rows;
  for (const isa::OpRow& row : isa::op_table())
    rows.push_back({std::string(row.name), std::string(name_of(row.klass)), std::string(name_of(row.unit)),
                    std::string(row.doc)});
  return rows;
}

// Returns each op with the file of the test that checks what it does, and the number of its examples.
Rows test_rows() {
  Rows rows;
  for (const isa::OpRow& row : isa::op_table()) {
    const std::string_view test = isa::test_of(row);
    rows.push_back({std::string(row.name), std::string(test),
                    row.examples.count ? fmt::format("{} examples", row.examples.count) : ""});
  }
  return rows;
}

// Returns number, name, and the values that --material can change.
Rows material_rows(const std::string& name, const std::string& assets) {
  if (name.empty())
    throw UserError({}, "the materials of which scene?", "for example `glint list materials WKND`");
  const scenes::Scene scene = scenes::load_scene(name, {assets, false, {}, 0});
  Rows rows = {{"number", "name", "model", "diffuse", "fuzziness", "refraction_index", "texture"}};
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const scenes::Material& m = scene.materials[i];
    rows.push_back({fmt::format("{}", i), i < scene.material_names.size() ? scene.material_names[i] : "",
                    std::string(scenes::name_of(m.model)),
                    fmt::format("{:.6g},{:.6g},{:.6g}", m.diffuse[0], m.diffuse[1], m.diffuse[2]),
                    fmt::format("{:.6g}", m.fuzziness), fmt::format("{:.6g}", m.refraction_index),
                    m.texture < 0 ? "none" : fmt::format("{}", m.texture)});
  }
  return rows;
}

struct ListOptions {
  std::string what, scene, assets;
  bool markdown = false, tests = false;
};

Exit list(const Session& session, const ListOptions& options) {
  const auto& [what, scene, assets, markdown, tests] = options;
  if (!scene.empty() && what != "materials")
    throw UserError({}, fmt::format("'{}' goes with materials, and not with {}", scene, what));
  if (tests && what != "ops")
    throw UserError({}, fmt::format("--tests goes with ops, and not with {}", what),
                    "`glint list ops --tests` prints the test of each op");
  if (what == "stats") {
    write_output("", markdown ? stat_list_markdown() : stat_list());
    return Exit::Ok;
  }
  if (what == "metrics" && markdown) {
    write_output("", metrics_page());
    return Exit::Ok;
  }
  const Rows rows = what == "scenes"      ? scene_rows()
                    : what == "materials" ? material_rows(scene, assets)
                    : what == "shaders"   ? shader_rows()
                    : what == "workloads" ? workload_rows()
                    : what == "programs"  ? program_rows()
                    : what == "configs"   ? config_rows(session.resources)
                    : what == "oracles"   ? oracle_rows()
                    : what == "ops"       ? (tests ? test_rows() : op_rows())
                    : what == "metrics"   ? metric_rows()
                                          : policy_rows();
  write_output("", report::table(rows, ""));
  return Exit::Ok;
}

}  // namespace

void add_list(Command app, Session& session) {
  auto options = std::make_shared<ListOptions>();
  Command command = app.add_subcommand(
      "list",
      "List scenes, materials, shaders, workloads, programs, configs, policies, oracles, ops, stats or "
      "metrics");
  command.add_option("WHAT", options->what, "What to list")
      .required()
      .one_of({"scenes", "materials", "shaders", "workloads", "programs", "configs", "policies", "oracles",
               "ops", "stats", "metrics"});
  command.add_option("SCENE", options->scene, "Scene or file whose materials to list (with materials)");
  add_assets_option(command, options->assets, " (with materials)");
  command.add_flag("--markdown", options->markdown,
                   "Print stats or metrics as docs/stats.md and docs/metrics.md have them");
  command.add_flag("--tests", options->tests, "Print the test that checks what each op does (with ops)");
  command.callback(
      [&session, options] { session.action = [&session, options] { return list(session, *options); }; });
}

}  // namespace glint::app
