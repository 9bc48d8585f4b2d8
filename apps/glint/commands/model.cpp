// Declares `glint model RUN...`, which compares cycles that analytical models predict with simulated ones.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <memory>

#include "apps/glint/bench/tables.h"
#include "apps/glint/options/command_line.h"
#include "apps/glint/options/config.h"
#include "apps/glint/options/output.h"
#include "apps/glint/options/run_files.h"
#include "apps/glint/run/relaunch.h"
#include "apps/glint/session.h"
#include "base/regular_file.h"
#include "pipeline/interval/interval_machine.h"
#include "pipeline/run_stats.h"
#include "report/analytical/hong_kim.h"
#include "report/analytical/model_table.h"
#include "report/files/csv_table.h"
#include "report/files/run_directory.h"
#include "report/files/run_record.h"
#include "report/metrics/compare_samples.h"
#include "report/terminal/progress.h"

namespace glint::app {
namespace {

struct ModelOptions {
  std::vector<std::string> runs;
  std::string out;
  bool statistics_only = false, inputs = false;
  RelaunchOptions again;
};

using Columns = std::vector<std::pair<std::string, double>>;

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

// Runs every launch of a run through the interval model, and returns the predicted cycles of all.
double run_interval(const Session& session, const ModelOptions& options, const report::RunRecord& run,
                    const std::string& directory, Columns& columns) {
  const pipeline::GpuParams gpu = read_config(session.resources, directory + "/config.toml", {});
  pipeline::IntervalDevice device(gpu);
  double seconds = 0;
  relaunch(session, options.again, run, directory, gpu, [&](const exec::World& world, bool warm) {
    const auto begin = std::chrono::steady_clock::now();
    const pipeline::IntervalEstimate estimate = device.run(world, warm);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    pipeline::RenderResult out;
    out.cycles = estimate.cycles;
    out.warp_instructions = estimate.instructions;
    out.lane_instructions = estimate.lanes;
    out.stats = std::make_unique<pipeline::RunStats>(pipeline::FunctionalCounts{});
    return out;
  });
  const pipeline::IntervalEstimate& sum = device.sum();
  const Columns found = columns_of(sum, seconds);
  columns.insert(columns.end(), found.begin(), found.end());
  double simulated = 0;
  for (const double instructions : run.values("gpu.core[*].instructions")) simulated += instructions;
  if (double(sum.instructions) != simulated)
    throw UserError(
        {directory},
        fmt::format("the run executed {:.0f} warp instructions, and the same launches executed {} here",
                    simulated, sum.instructions),
        "another version of Glint made the run, or it had options that run.json does not have: run it again");
  return double(sum.cycles);
}

// Returns the number of launches of a run: those of a compute program stand in a table of their own, and each
// frame of a sequence is one.
double launches_of(const std::string& directory) {
  if (const size_t frames = report::frames_of(directory).size(); frames > 0) return double(frames);
  const std::string path = directory + "/launches.csv";
  const std::optional<std::string> text = read_regular_file(path);
  return text ? std::max(1.0, double(report::read_csv(*text, path).rows.size())) : 1.0;
}

report::ModelRow row_of(const Session& session, const ModelOptions& options, bool with_interval,
                        const std::string& workload, const std::string& directory) {
  const report::RunRecord run = report::RunRecord::read(directory);
  tell_of_files({directory});
  report::ModelRow row{.workload = workload, .cycles = 0, .predicted = {}, .inputs = {}};
  const report::HongKimInputs inputs = report::hong_kim_inputs(run, directory, launches_of(directory));
  const report::HongKimResult model = report::hong_kim(inputs);
  for (const double cycles : run.values("gpu.cycles")) row.cycles += cycles;
  row.predicted = {model.cycles, report::hong_kim(report::as_lumibench(inputs)).cycles};
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
    const std::string why = why_not_relaunched(report::RunRecord::read(directory));
    if (why.empty()) continue;
    fmt::print(
        stderr,
        "note: the interval model runs launches again, which it cannot for {}, because {}: it is left out\n",
        directory, why);
    return false;
  }
  return true;
}

report::ModelTable table_of(const Session& session, const ModelOptions& options, const Runs& runs,
                            bool with_interval) {
  report::ModelTable models;
  models.models = {"Hong and Kim", "as in LumiBench"};
  if (with_interval) models.models.push_back("interval model");
  report::Progress progress(session.on_terminal ? stdout : nullptr, "models", session.terminal);
  for (const auto& [workload, directory] : runs) {
    models.rows.push_back(row_of(session, options, with_interval, workload, directory));
    progress.update(models.rows.size(), runs.size());
  }
  return models;
}

// Returns the predictions of all models that know all of the runs. Says on stderr why one does not.
report::ModelTable models_of(const Session& session, const ModelOptions& options, const Runs& runs) {
  const bool with_interval = !options.statistics_only && takes_interval(runs);
  try {
    return table_of(session, options, runs, with_interval);
  } catch (const UnsupportedError& refused) {
    if (!with_interval) throw;
    fmt::print(stderr, "{}note: it is left out, as with --statistics-only\n", refused.what());
    return table_of(session, options, runs, false);
  }
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
  for (const auto& [workload, directory] : runs)
    if (report::is_sampled(report::RunRecord::read(directory)))
      throw UserError({directory}, "the run timed only a sample of its launch, and models predict whole ones",
                      "run it again without --sample-pixels");
  const report::ModelTable models = models_of(session, options, runs);
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
                   "Compute Hong and Kim's model alone, without a pass over the launches");
  add_assets_option(command, options->again.assets, ", as the runs were given it");
  command
      .add_option("--shader-dir", options->again.shader_dir,
                  "Folder with the shaders, as the runs of scenes were given it")
      .type_name("DIR");
  add_shader_options(command, options->again.shaders);
  command.callback(
      [&session, options] { session.action = [&session, options] { return model(session, *options); }; });
}

}  // namespace glint::app
