// Declares `glint ablate FROM TO`, which says what each difference of two configurations does.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <set>

#include "apps/glint/bench/bench.h"
#include "apps/glint/lab/ablation.h"
#include "apps/glint/options/command_line.h"
#include "apps/glint/options/config.h"
#include "apps/glint/options/frame_options.h"
#include "apps/glint/options/output.h"
#include "apps/glint/session.h"
#include "report/files/run_directory.h"

namespace glint::app {
namespace {

struct AblateOptions {
  AblationOptions ablation;
  std::vector<std::string> workloads = {"subset"}, kinds = {"alone", "back", "step"};
  std::vector<std::string> metrics = {"cycles",        "thread_ipc",   "lat_rt%",       "lat_mem%",
                                      "rt_occupancy",  "rt_miss_rate", "l1d_miss_rate", "l2_miss_rate",
                                      "rt_efficiency", "dram_eff",     "dram_util"};
  std::string assets, out;
  FrameOptions frame;
  bool small = false, plan = false, commands = false;
  uint32_t processes = 0;
};

BenchOptions bench_of(const AblateOptions& options, const AblationArm& arm, const std::string& folder) {
  BenchOptions out;
  out.names = options.workloads;
  out.config = options.ablation.from;
  out.settings = arm.settings;
  out.assets = options.assets;
  out.out = folder + "/" + arm.folder;
  out.frame = options.frame;
  out.small = options.small;
  out.processes = options.processes;
  out.resume = true;
  out.stats = "compact";
  return out;
}

void print_plan(const Ablation& ablation) {
  std::set<std::string> folders;
  for (const AblationArm& arm : ablation.arms)
    if (arm.refused.empty()) folders.insert(arm.folder);
  print_output("{} groups of keys, {} machines\n", ablation.groups.size(), folders.size());
  for (const AblationGroup& group : ablation.groups)
    print_output("{:<20} {}\n", group.name, fmt::join(group.settings, " "));
  for (const AblationArm& arm : ablation.arms)
    if (!arm.refused.empty()) print_output("{} is refused: {}\n", arm.folder, arm.refused);
}

// Prints the `glint bench` of each machine. Whoever runs them all, in any order and on any number of hosts,
// leaves nothing to run for the ablation.
void print_commands(const Ablation& ablation, const AblateOptions& options, const std::string& folder) {
  const auto quoted = [](const std::string& word) {
    std::string out = "'";
    for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
  };
  std::set<std::string> done;
  for (const AblationArm& arm : ablation.arms) {
    if (!arm.refused.empty() || !done.insert(arm.folder).second) continue;
    const BenchOptions bench = bench_of(options, arm, folder);
    std::string text = "glint bench";
    for (const std::string& name : bench.names) text += " " + quoted(name);
    text += " --config " + quoted(bench.config);
    for (const std::string& setting : bench.settings) text += " --set " + quoted(setting);
    for (const std::string& word : bench.frame.arguments()) text += " " + quoted(word);
    if (bench.small) text += " --small";
    if (!bench.assets.empty()) text += " --assets " + quoted(bench.assets);
    if (bench.processes) text += fmt::format(" -j {}", bench.processes);
    print_output("{} --stats {} --resume --out {}\n", text, bench.stats, quoted(bench.out));
  }
}

Exit ablate(const Session& session, AblateOptions options) {
  const auto has = [&](const char* kind) {
    return std::find(options.kinds.begin(), options.kinds.end(), kind) != options.kinds.end();
  };
  options.ablation.alone = has("alone"), options.ablation.back = has("back"),
  options.ablation.steps = has("step");
  const Ablation ablation = plan_ablation(session.resources, options.ablation);
  const auto stem = [](const std::string& config) { return std::filesystem::path(config).stem().string(); };
  const std::string folder =
      !options.out.empty()
          ? options.out
          : fmt::format("out/ablate-{}-{}", stem(options.ablation.from), stem(options.ablation.to));
  if (options.commands) return print_commands(ablation, options, folder), Exit::Ok;
  print_plan(ablation);
  if (options.plan) return Exit::Ok;
  std::set<std::string> done;
  for (const AblationArm& arm : ablation.arms) {
    if (!arm.refused.empty() || !done.insert(arm.folder).second) continue;
    print_output("\n{}\n", arm.folder);
    if (const Exit exit = run_bench(session, bench_of(options, arm, folder)); exit != Exit::Ok) return exit;
  }
  const AblationMeans means = read_means(ablation, folder);
  const std::string table = ablation_table(ablation, means, options.metrics);
  report::write_file(folder + "/ablation.txt", table);
  report::write_file(folder + "/ablation.csv", ablation_csv(ablation, means));
  report::write_file(folder + "/ablation.html", ablation_page(ablation, means, options.metrics));
  print_output("\n{}\nresults in {}/ablation.csv and ablation.html\n", table, folder);
  return Exit::Ok;
}

}  // namespace

void add_ablate(Command app, Session& session) {
  auto options = std::make_shared<AblateOptions>();
  Command command = app.add_subcommand(
      "ablate", "Change one configuration into another step by step and say what each does");
  command.add_option("FROM", options->ablation.from, "Preset or TOML file to begin with").required();
  command.add_option("TO", options->ablation.to, "Preset or TOML file to end with").required();
  command.add_option("--workloads", options->workloads,
                     "What to run, named as for 'glint bench' (default: subset)");
  command.add_option("--only", options->ablation.only, "Change only keys whose names begin so (default: all)")
      .type_name("PREFIX");
  command
      .add_option("--order", options->ablation.order,
                  "Groups that the steps begin with (default: the order of the configuration)")
      .type_name("GROUP");
  command.add_flag("--keys", options->ablation.by_key,
                   "Change every key alone instead of a table's keys together");
  command
      .add_option("--kinds", options->kinds,
                  "Which machines to run beside the two: alone (FROM with one group), back (TO without it), "
                  "step (FROM with it and all before it)")
      .one_of({"alone", "back", "step"});
  command.add_option("--metrics", options->metrics,
                     "Metrics to show; 'glint list metrics' names them (default: eleven of them)");
  command.add_flag("--plan", options->plan, "Print the groups and the number of machines, and run nothing");
  command.add_flag(
      "--commands", options->commands,
      "Print the 'glint bench' of each machine, to be run elsewhere or side by side, and run nothing");
  add_jobs_option(command, options->processes);
  add_assets_option(command, options->assets);
  command
      .add_option("--out", options->out,
                  "Folder for the results, with a folder for each machine; what is complete there is not run "
                  "again (default: out/ablate-FROM-TO)")
      .type_name("DIR");
  command.add_flag("--small", options->small, "Run compute programs on their small inputs");
  add_frame_options(command, options->frame);
  command.callback(
      [&session, options] { session.action = [&session, options] { return ablate(session, *options); }; });
}

}  // namespace glint::app
