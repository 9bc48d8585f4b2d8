// Declares `glint lab NAME`, which runs an experiment on a published idea and sets the result beside the
// paper's.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "apps/glint/bench/bench.h"
#include "apps/glint/lab/experiment.h"
#include "apps/glint/lab/pairs.h"
#include "apps/glint/lab/results.h"
#include "apps/glint/options/command_line.h"
#include "apps/glint/options/config.h"
#include "apps/glint/options/output.h"
#include "apps/glint/options/report_writer.h"
#include "apps/glint/session.h"
#include "report/files/run_directory.h"
#include "setup/config.h"
#include "setup/oracles.h"

namespace glint::app {
namespace {

struct LabOptions {
  std::string name, config, out, size;
  std::vector<std::string> workloads, arms, oracles;
  uint32_t processes = 0;
  bool check = false;
};

// Leaves the arms that were asked for, and the baselines that they need.
void choose_arms(const std::vector<std::string>& names, Experiment& experiment) {
  if (names.empty()) return;
  std::vector<LabArm> chosen;
  std::vector<std::string> all, wanted = names;
  for (const LabArm& arm : experiment.arms) all.push_back(arm.name);
  for (const std::string& name : names)
    if (std::find(all.begin(), all.end(), name) == all.end())
      throw UserError(
          fmt::format("'{}' has no arm '{}'; it has {}", experiment.name, name, fmt::join(all, ", ")));
  const auto is_wanted = [&](const std::string& name) {
    return std::find(wanted.begin(), wanted.end(), name) != wanted.end();
  };
  for (size_t i = experiment.arms.size(); i-- > 0;)
    if (is_wanted(experiment.arms[i].name)) wanted.push_back(experiment.arms[i].against);
  for (const LabArm& arm : experiment.arms)
    if (is_wanted(arm.name)) chosen.push_back(arm);
  experiment.arms = std::move(chosen);
}

std::vector<std::string> names_of(const std::vector<std::string>& named) {
  std::vector<std::string> out;
  for (const NamedWorkload& one : named.empty() ? lumibench() : select_workloads(named))
    out.push_back(one.name());
  return out;
}

// Returns the workloads of an arm: those of its list that were asked for.
std::vector<std::string> workloads_of(const Experiment& experiment, const LabArm& arm,
                                      const std::vector<std::string>& asked) {
  std::vector<std::string> out = names_of(arm.workloads.empty() ? experiment.workloads : arm.workloads);
  const std::vector<std::string> wanted = names_of(asked);
  std::erase_if(out, [&](const std::string& name) {
    return std::find(wanted.begin(), wanted.end(), name) == wanted.end();
  });
  return out;
}

// Refuses an arm with a workload that its baseline does not run, before anything runs.
void check_baselines(const Experiment& experiment) {
  for (const LabArm& arm : experiment.arms) {
    const auto base = std::find_if(experiment.arms.begin(), experiment.arms.end(),
                                   [&](const LabArm& one) { return one.name == arm.against; });
    if (base == experiment.arms.end()) continue;
    for (const std::string& name : arm.workloads)
      if (std::find(base->workloads.begin(), base->workloads.end(), name) == base->workloads.end())
        throw UserError(fmt::format("the arm '{}' runs {}, which its baseline '{}' does not run", arm.name,
                                    name, arm.against));
  }
}

// Leaves out the arms that have nothing to run.
void drop_empty_arms(const std::vector<std::string>& asked, Experiment& experiment) {
  std::erase_if(experiment.arms, [&](LabArm& arm) {
    arm.workloads = workloads_of(experiment, arm, asked);
    return arm.workloads.empty();
  });
  if (experiment.arms.empty())
    throw UserError(
        fmt::format("'{}' has none of these workloads: {}", experiment.name, fmt::join(asked, ", ")));
}

// Every arm is a bench of its own, which leaves out what an earlier one has completed.
BenchOptions bench_of(const Experiment& experiment, const LabArm& arm, const LabOptions& options,
                      const std::string& folder) {
  BenchOptions out;
  out.names = arm.workloads;
  out.config = experiment.config;
  std::vector<std::string> oracles = options.oracles;
  oracles.insert(oracles.end(), arm.oracles.begin(), arm.oracles.end());
  out.settings = setup::with_oracles(oracles, experiment.settings);
  out.settings.insert(out.settings.end(), arm.settings.begin(), arm.settings.end());
  out.out = folder + "/" + arm.name;
  out.frame.size = experiment.size;
  out.frame.params.samples = experiment.samples;
  out.frame.params.bounces = experiment.bounces;
  out.frame.params.ao_reach = arm.ao_reach.value_or(experiment.ao_reach);
  out.processes = options.processes;
  out.resume = true;
  out.stats = "compact";
  return out;
}

// Writes the document and the page that `glint report` makes of it.
void write_page(const Session& session, const Experiment& experiment, const std::vector<LabResult>& results,
                const std::vector<RefusedPair>& refused, const std::string& folder) {
  nlohmann::ordered_json document = lab_json(experiment, results);
  for (const RefusedPair& pair : refused)
    document["refused"].push_back({{"first", pair.first}, {"second", pair.second}, {"reason", pair.reason}});
  report::write_file(folder + "/lab.json", document.dump(1) + "\n");
  write_report(session, {folder}, "", std::nullopt);
}

Exit conclude(const Session& session, const Experiment& experiment, const std::vector<RefusedPair>& refused,
              const LabOptions& options, const std::string& folder) {
  const std::vector<LabResult> results = lab_results(experiment, folder);
  const std::string table = lab_table(experiment, results) + pair_table(results, refused);
  report::write_file(folder + "/lab.txt", table);
  report::write_file(folder + "/lab.csv", lab_csv(results));
  print_output("\n{}\nresults in {}/lab.csv\n", table, folder);
  write_page(session, experiment, results, refused, folder);
  if (!options.check) return Exit::Ok;
  std::string flipped;
  for (const LabResult& result : results)
    if (result.has_published_sign() == false) flipped += " " + result.arm->name;
  if (flipped.empty()) return Exit::Ok;
  fmt::print(stderr, "error: the effect has not the published sign:{}\n", flipped);
  return Exit::Failure;
}

std::string stem_of(const std::string& config) {
  return std::filesystem::path(config).stem().string();
}

// Says at the file's line that its configuration is none.
void check_config(const Session& session, const Experiment& experiment) {
  try {
    setup::read_preset(session.resources, experiment.config);
  } catch (const UserError& error) {
    const std::string what = error.what();  // An error without a place begins with "error: ".
    if (!what.starts_with("error: ")) throw;
    throw UserError(experiment.config_where, what.substr(what.find(' ') + 1));
  }
}

Exit run_lab(const Session& session, const LabOptions& options) {
  Experiment experiment = read_experiment(session.resources.lab_path(options.name));
  if (!options.config.empty())
    experiment.config = options.config;
  else
    check_config(session, experiment);
  if (!options.size.empty()) experiment.size = options.size;
  std::vector<RefusedPair> refused;
  if (experiment.pairs) refused = add_pairs(session.resources, experiment);
  choose_arms(options.arms, experiment);
  drop_empty_arms(options.workloads, experiment);
  check_baselines(experiment);
  const std::string folder = !options.out.empty() ? options.out
                             : options.config.empty()
                                 ? "out/lab-" + experiment.name
                                 : "out/lab-" + experiment.name + "-" + stem_of(options.config);
  for (const LabArm& arm : experiment.arms) {
    const std::vector<std::string> changes = setup::with_oracles(arm.oracles, arm.settings);
    print_output("\n{}: {}\n", arm.name,
                 changes.empty() ? "the machine as it is" : fmt::format("{}", fmt::join(changes, " ")));
    if (const Exit exit = run_bench(session, bench_of(experiment, arm, options, folder)); exit != Exit::Ok)
      return exit;
  }
  return conclude(session, experiment, refused, options, folder);
}

Exit list_labs(const Session& session) {
  for (const std::string& name : session.resources.lab_names()) {
    const Experiment one = read_experiment(session.resources.lab_path(name));
    print_output("{:<12} {}\n", name, one.title);
  }
  return Exit::Ok;
}

}  // namespace

void add_lab(Command app, Session& session) {
  auto options = std::make_shared<LabOptions>();
  Command command = app.add_subcommand(
      "lab", "Run an experiment on a published idea and compare the effect with the paper's");
  command.add_option("NAME", options->name,
                     "Experiment, or a TOML file that describes one (default: list the experiments)");
  add_jobs_option(command, options->processes);
  command.add_option("--config", options->config,
                     "Preset or file of another machine for all arms (default: the experiment's)");
  add_oracle_option(command, options->oracles);
  command.add_option("--workloads", options->workloads,
                     "Which of the experiment's workloads to run, named as for 'glint bench' (default: all)");
  command.add_option("--arms", options->arms, "Arms to run, with their baselines (default: all)");
  command.add_option("--size", options->size, "Image size in pixels (default: the experiment's)")
      .type_name("WxH");
  command
      .add_option(
          "--out", options->out,
          "Folder for the results, with a folder for each arm; what is complete there is not run again "
          "(default: out/lab-NAME, or out/lab-NAME-CONFIG)")
      .type_name("DIR");
  command.add_flag("--check", options->check,
                   "Exit with code 1 when an effect has not the sign that was published");
  command.callback([&session, options] {
    session.action = [&session, options] {
      return options->name.empty() ? list_labs(session) : run_lab(session, *options);
    };
  });
}

}  // namespace glint::app
