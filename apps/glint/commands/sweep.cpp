// Declares `glint sweep`, which hands its command line to the Python package: a sweep's engines are Python's.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "apps/glint/options/command_line.h"
#include "apps/glint/options/python_package.h"
#include "apps/glint/session.h"

namespace glint::app {
namespace {

// Only their rules count here. The package reads the same words again (python/glint/sweeps/command.py), and a
// test compares the two lists.
struct SweepOptions {
  std::string action, file, store, engine, scheduler, out, point, python = "python3";
  std::vector<std::string> slurm;
  uint32_t workers = 0, chunk = 0;
  double memory = 0;
  bool detach = false, failed = false, yes = false, json = false, dry_run = false;
};

void add_options(Command command, SweepOptions& options) {
  command
      .add_option("ACTION", options.action,
                  "What to do: run, status, resume, cancel, collect, report, open or gc (docs/sweeps.md)")
      .required()
      .one_of({"run", "status", "resume", "cancel", "collect", "report", "open", "gc"});
  command.add_option("SWEEP", options.file, "File of the sweep (sweep.toml), or its name in the store");
  command
      .add_option("--store", options.store,
                  "Folder that keeps the points of all sweeps (default: the file's `store`, else out/store)")
      .type_name("DIR");
  command
      .add_option("--engine", options.engine,
                  "Who distributes the points: processes of this machine, a Slurm cluster, or a Dask one "
                  "(default: the file's, else local)")
      .one_of({"local", "slurm", "dask"});
  command.add_option("--workers", options.workers,
                     "Number of points to run at a time on this machine; 0: one for each processor");
  command.add_option("--memory", options.memory,
                     "Memory in GB that the points on this machine may take together; 0: what is available");
  command.add_option("--scheduler", options.scheduler,
                     "Address of a Dask scheduler (tcp://HOST:PORT; default: a cluster on this machine)");
  command.add_option("--chunk", options.chunk,
                     "Number of points of a task of a cluster; 0: chosen by their number");
  command
      .add_option("--slurm", options.slurm, "Option for sbatch, such as --slurm=--partition=long; repeatable")
      .allow_extra_args(false);
  command.add_flag("--detach", options.detach,
                   "Leave once all tasks are submitted, and do not wait for them");
  command.add_flag("--failed", options.failed, "Let `resume` also run points again that have failed");
  command.add_flag("--dry-run", options.dry_run, "Check all points and say what would be run");
  command
      .add_option("--out", options.out,
                  "Folder for tables and page (default: out/sweep-NAME), or for the run that `open` unpacks")
      .type_name("DIR");
  command.add_option("--point", options.point,
                     "The point that `open` unpacks: its id or the beginning of it");
  command.add_flag("--yes", options.yes, "Let `gc` remove what it lists");
  command.add_flag("--json", options.json, "Print the status as JSON");
  add_python_option(command, options.python);
}

}  // namespace

void add_sweep(Command app, Session& session) {
  auto options = std::make_shared<SweepOptions>();
  Command command = app.add_subcommand(
      "sweep",
      "Run workloads over many configurations, on this machine or on a cluster, and collect the results");
  add_options(command, *options);
  command.callback([&session, options] {
    session.action = [&session, options] {
      return hand_over(session, options->python, "glint.sweeps", "sweep");
    };
  });
}

}  // namespace glint::app
