// Declares `glint model RUN...`, which compares cycles that analytical models predict with simulated ones.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <memory>

#include "apps/glint/bench/tables.h"
#include "apps/glint/bench/workloads.h"
#include "apps/glint/options/command_line.h"
#include "apps/glint/options/config.h"
#include "apps/glint/options/output.h"
#include "apps/glint/options/run_files.h"
#include "apps/glint/options/shader_options.h"
#include "apps/glint/session.h"
#include "base/regular_file.h"
#include "pipeline/interval/interval_machine.h"
#include "pipeline/scene_world.h"
#include "pipeline/structure_cache.h"
#include "report/analytical/hong_kim.h"
#include "report/analytical/model_table.h"
#include "report/files/csv_table.h"
#include "report/files/run_directory.h"
#include "report/terminal/progress.h"
#include "scenes/overrides.h"

namespace glint::app {
namespace {

struct ModelOptions {
  std::vector<std::string> runs;
  std::string out, assets;
  bool statistics_only = false, inputs = false;
  ShaderOptions shaders;
};

using Columns = std::vector<std::pair<std::string, double>>;

double fact(const report::RunRecord& run, const std::string& directory, const std::string& name) {
  if (const std::optional<double> value = run.fact(name)) return *value;
  throw UserError({directory + "/run.json"}, fmt::format("has no '{}'", name),
                  "the interval model takes runs of scenes; --statistics-only leaves it out");
}

// Returns the name or the file of a run's scene.
std::string scene_of(const report::RunRecord& run, const std::string& directory) {
  const std::string file = run.text("scene.file");
  if (file.empty()) return run.text("scene.name");
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed))
    throw UserError({directory + "/run.json"},
                    fmt::format("the file of the run's scene, '{}', is not here", file),
                    "call `glint model` from the folder that the run was called from");
  return file;
}

// Returns the job of the launch that a run made.
pipeline::RenderJob job_of(const Session& session, const ModelOptions& options, const report::RunRecord& run,
                           const std::string& directory) {
  const std::string shader = run.text("shader");
  const WorkloadInfo& workload = find_workload(shader);
  pipeline::RenderJob job;
  job.gpu = read_config(session.resources, directory + "/config.toml", {});
  job.workload = workload.workload;
  for (const scenes::RenderParam& p : scenes::RenderParams::params())
    job.frame.*p.field = uint32_t(p.is_optional ? run.fact(std::string(p.key)).value_or(0)
                                                : fact(run, directory, std::string(p.key)));
  job.shader_dir = session.resources.shader_dir(std::string(workload.folder));
  job.scene = scenes::load_scene(scene_of(run, directory), {options.assets, false, {}});
  scenes::override_scene(job.scene, run.texts_in("overrides"));
  if (fmt::format("{:016x}", job.scene.hash()) != run.text("scene.hash"))
    throw UserError(
        {directory + "/run.json"},
        fmt::format("the run's scene is '{}', and here it is '{}'", run.text("scene.form"), job.scene.form),
        run.text("scene.file").empty() ? "--assets names the folder that the run was given"
                                       : "the file has changed since, or the run had --instancing");
  return job;
}

Columns columns_of(const pipeline::IntervalEstimate& estimate, double seconds) {
  Columns out = {{"interval_rays", double(estimate.rays.rays)},
                 {"interval_nodes", double(estimate.rays.nodes)},
                 {"interval_traces", double(estimate.rays.traces)},
                 {"interval_trace_cycles", double(estimate.rays.trace_cycles)},
                 {"interval_l1_shader_reads", double(estimate.l1[0].reads)},
                 {"interval_l1_shader_misses", double(estimate.l1[0].misses)},
                 {"interval_l1_rt_reads", double(estimate.l1[1].reads)},
                 {"interval_l1_rt_misses", double(estimate.l1[1].misses)},
                 {"interval_l2_reads", double(estimate.l2.reads)},
                 {"interval_l2_misses", double(estimate.l2.misses)},
                 {"interval_dram_sectors", double(estimate.dram_sectors)}};
  for (const auto& [name, cycles] : estimate.bounds())
    out.emplace_back(fmt::format("bound: {}", name), cycles);
  out.emplace_back("interval_seconds", seconds);
  return out;
}

double run_interval(const Session& session, const ModelOptions& options, const report::RunRecord& run,
                    const std::string& directory, Columns& columns) {
  const std::unique_ptr<frontend::ShaderCache> cache = open_shader_cache(options.shaders);
  const std::unique_ptr<pipeline::StructureCache> structures =
      open_structure_cache(options.shaders, session.plugins);
  pipeline::RenderJob job = job_of(session, options, run, directory);
  job.glsl = glsl_options(options.shaders, cache.get());
  job.structure_cache = structures.get();
  pipeline::SceneWorld scene(job);
  pipeline::IntervalMachine machine(job.gpu, scene.world);
  const auto begin = std::chrono::steady_clock::now();
  const pipeline::IntervalEstimate estimate = machine.run({});
  const Columns found =
      columns_of(estimate, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  columns.insert(columns.end(), found.begin(), found.end());
  double simulated = 0;
  for (const double instructions : run.values("gpu.core[*].instructions")) simulated += instructions;
  if (double(estimate.instructions) != simulated)
    throw UserError(
        {directory},
        fmt::format("the run executed {:.0f} warp instructions, and the same launch executed {} here",
                    simulated, estimate.instructions),
        "another version of Glint made the run, or it had options that run.json does not have: run it again");
  return double(estimate.cycles);
}

// Returns the number of launches of a run: those of a compute program stand in a table of their own.
double launches_of(const std::string& directory) {
  const std::string path = directory + "/launches.csv";
  const std::optional<std::string> text = read_regular_file(path);
  return text ? std::max(1.0, double(report::read_csv(*text, path).rows.size())) : 1.0;
}

report::ModelRow row_of(const Session& session, const ModelOptions& options, bool with_interval,
                        const std::string& workload, const std::string& directory) {
  const report::RunRecord run = report::RunRecord::read(directory);
  tell_of_files({directory});
  report::ModelRow row{.workload = workload, .cycles = 0, .predicted = {}, .inputs = {}};
  const report::HongKimResult model =
      report::hong_kim(report::hong_kim_inputs(run, directory, launches_of(directory)));
  for (const double cycles : run.values("gpu.cycles")) row.cycles += cycles;
  row.predicted.push_back(model.cycles);
  row.inputs = report::hong_kim_columns(model);
  if (with_interval) row.predicted.push_back(run_interval(session, options, run, directory, row.inputs));
  return row;
}

std::string inputs_text(const report::ModelTable& models) {
  std::string out;
  for (const report::ModelRow& row : models.rows) {
    std::vector<std::vector<std::string>> rows;
    for (const auto& [name, value] : row.inputs) rows.push_back({name, fmt::format("{:.6g}", value)});
    out += fmt::format("\n{}\n{}", row.workload, report::table(rows, "<>", "  "));
  }
  return out;
}

using Runs = std::vector<std::pair<std::string, std::string>>;  // workload and directory

// Returns whether the interval model takes all runs. When it does not, says on stderr which run is in the
// way.
bool takes_interval(const Runs& runs) {
  for (const auto& [workload, directory] : runs) {
    const report::RunRecord run = report::RunRecord::read(directory);
    if (run.fact("rays.bounces")) continue;
    fmt::print(stderr,
               "note: the interval model takes runs of scenes, and {} is of {} '{}': it is left out\n",
               directory, run.text("scene.form") == "pipeline" ? "the pipeline" : "the kernel",
               run.text("scene.name"));
    return false;
  }
  return true;
}

// Returns the path of the table: in the one directory that was named, or beside several.
std::string table_path(const ModelOptions& options) {
  if (!options.out.empty()) return options.out;
  if (options.runs.size() == 1) return options.runs[0] + "/models.csv";
  const auto parent = [](const std::string& run) {
    std::filesystem::path path = std::filesystem::path(run).lexically_normal();
    if (!path.has_filename()) path = path.parent_path();
    return path.parent_path();
  };
  const std::filesystem::path folder = parent(options.runs[0]);
  for (const std::string& run : options.runs)
    if (folder.empty() || parent(run) != folder)
      throw UserError({run},
                      "the runs lie in no folder of their own in which the table could lie beside them",
                      "--out names the file of the table");
  return (folder / "models.csv").string();
}

Exit model(const Session& session, const ModelOptions& options) {
  const std::string out = table_path(options);
  Runs runs;
  for (const std::string& folder : options.runs)
    for (const auto& run : finished_runs(folder)) runs.push_back(run);
  const bool with_interval = !options.statistics_only && takes_interval(runs);
  report::ModelTable models;
  models.models = {"Hong and Kim"};
  if (with_interval) models.models.push_back("interval model");
  report::Progress progress(session.on_terminal ? stdout : nullptr, "models", session.terminal);
  for (const auto& [workload, directory] : runs) {
    models.rows.push_back(row_of(session, options, with_interval, workload, directory));
    progress.update(models.rows.size(), runs.size());
  }
  write_output(out, report::model_csv(models));
  if (out == "-") return Exit::Ok;
  write_output("", report::model_text(models) + (options.inputs ? inputs_text(models) : ""));
  print_output("\n{}\n`glint report {}` draws it\n", out,
               options.out.empty() && options.runs.size() == 1 ? options.runs[0] : out);
  return Exit::Ok;
}

}  // namespace

void add_model(Command app, Session& session) {
  auto options = std::make_shared<ModelOptions>();
  Command command = app.add_subcommand(
      "model",
      "Predict cycles of finished runs by analytical models and compare them with the simulated cycles");
  command
      .add_option("RUN", options->runs,
                  "Directories of runs on the timing machine, or folders of `glint bench`")
      .required();
  command
      .add_option("-o,--out", options->out,
                  "File to write the table with all inputs to, or - for stdout (default: models.csv in the "
                  "directory, or beside several directories of one folder)")
      .type_name("FILE");
  command.add_flag("--inputs", options->inputs, "Print the inputs of each run, too");
  command.add_flag("--statistics-only", options->statistics_only,
                   "Compute Hong and Kim's model alone, without a pass over the scene");
  add_assets_option(command, options->assets, ", as the runs were given it");
  add_shader_options(command, options->shaders);
  command.callback(
      [&session, options] { session.action = [&session, options] { return model(session, *options); }; });
}

}  // namespace glint::app
