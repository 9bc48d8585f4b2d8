// Runs the workloads of a bench as processes, and gathers their metrics.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/bench/bench.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <set>
#include <system_error>

#include "apps/glint/bench/estimate.h"
#include "apps/glint/bench/metrics_table.h"
#include "apps/glint/bench/tables.h"
#include "apps/glint/bench/view.h"
#include "apps/glint/options/output.h"
#include "apps/glint/run/recorded_run.h"
#include "apps/glint/run/stop_signals.h"
#include "base/host_threads.h"
#include "report/files/folder_lock.h"
#include "report/files/run_directory.h"
#include "report/files/run_facts.h"
#include "report/metrics/metrics.h"

namespace glint::app {
namespace {

// Returns the last line of a log that is not empty, which tells what a failed workload ended with.
std::string last_words(const std::string& log) {
  std::ifstream in(log);
  std::string line, error;
  while (std::getline(in, line))
    if (line.find("error:") != std::string::npos || error.empty()) error = line;
  return error;
}

class Bench {
 public:
  Bench(const Session& session, const BenchOptions& options)
      : options_(options),
        command_(session.arguments),
        plan_(plan_bench(session, options)),
        table_(plan_.directory, names_of(plan_)),
        is_live_(session.can_move_cursor),
        terminal_(session.terminal) {}

  Exit run() {
    choose();
    const report::RunDirectory directory(plan_.directory);
    const report::FolderLock lock(plan_.directory);
    table_ = MetricsTable(plan_.directory, names_of(plan_));  // as a bench left it that has ended just now
    if (table_.is_new()) write_metrics(directory);            // This marks the folder as that of a bench.
    take_complete();
    limits();
    announce();
    const int signal = run_chosen(directory);
    write_metrics(directory);  // The metrics are written even when nothing was left to run.
    return conclude(directory, signal);
  }

 private:
  static std::set<std::string> names_of(const BenchPlan& plan) {
    std::set<std::string> out;
    for (const BenchTask& task : plan.tasks) out.insert(task.workload.name());
    return out;
  }

  // Chooses what to run. Throws UserError when a folder is not of a run, before anything runs.
  void choose() {
    for (size_t i = 0; i < plan_.tasks.size(); ++i) {
      if (plan_.tasks[i].is_complete) continue;
      chosen_.push_back(i);
      if (std::filesystem::exists(plan_.tasks[i].directory))
        report::RunDirectory(plan_.tasks[i].directory).check_ours();
    }
  }

  void take_complete() {
    for (BenchTask& task : plan_.tasks) {
      if (!task.is_complete) continue;
      read_mark(task, task.process);
      set_row(task, report::RunRecord::read(task.directory));
    }
  }

  void set_row(const BenchTask& task, const report::RunRecord& record) {
    table_.set(task.workload.name(), report::metrics_row(task.workload.name(), record));
  }

  // Makes the folder of a workload, or marks an empty one, so that the run finds a folder of its own although
  // its log is there already.
  void prepare(const BenchTask& task) const {
    const report::RunDirectory made(task.directory);
    made.check_ours();
    report::RunInfo info;
    info.command = command_;
    info.version = GLINT_VERSION;
    if (!report::is_run_folder(task.directory)) made.mark(info);
    unmark(task);
  }

  void limits() {
    const uint64_t available = available_memory();
    limits_.processes = host_threads(options_.processes);
    limits_.memory = options_.memory > 0 ? uint64_t(options_.memory * 1e9) : available;
  }

  // Returns what the workloads run on: the frame of scenes, the size of the programs' inputs.
  std::string inputs() const {
    const auto has = [&](bool program) {
      return std::ranges::any_of(
          plan_.tasks, [&](const BenchTask& task) { return task.workload.is_program() == program; });
    };
    return (has(false) ? fmt::format("{}, {} spp, ", options_.frame.size, options_.frame.params.samples)
                       : "") +
           (has(true) ? options_.small ? "small inputs, " : "full inputs, " : "");
  }

  void announce() const {
    uint64_t largest = 0, together = 0;
    std::string name;
    std::vector<uint64_t> needs;
    for (const size_t i : chosen_) {
      const BenchTask& task = plan_.tasks[i];
      needs.push_back(task.process.memory);
      if (task.process.memory > largest) largest = task.process.memory, name = task.workload.name();
    }
    std::sort(needs.rbegin(), needs.rend());
    for (size_t i = 0; i < std::min<size_t>(needs.size(), limits_.processes); ++i) together += needs[i];
    print_output(
        "{} workloads{}: {}{} on {}, {} at a time, into {}\n", plan_.tasks.size(),
        options_.resume ? fmt::format(", {} of them complete", plan_.tasks.size() - chosen_.size()) : "",
        inputs(), options_.mode, options_.config, limits_.processes, plan_.directory);
    if (!plan_.left_out.empty())
      print_output("left out, because their scenes have no files in '{}': {}\n", options_.assets,
                   fmt::join(plan_.left_out, " "));
    if (chosen_.empty()) return;
    print_output("memory, estimated: {} for {}, {} for the largest together; limit {}\n", gigabytes(largest),
                 name, gigabytes(together), limits_.memory ? gigabytes(limits_.memory) : "not known");
    if (limits_.memory && largest > limits_.memory)
      fmt::print(stderr, "warning: {} may not fit into {}; it runs alone\n", name, gigabytes(limits_.memory));
    else if (limits_.memory && together > limits_.memory)
      print_output("fewer workloads run together when they would not fit\n");
  }

  // Returns 0, or the number of the signal that ended the bench early.
  int run_chosen(const report::RunDirectory& directory) {
    std::vector<Process> processes;
    std::vector<std::string> names;
    for (const size_t i : chosen_) {
      prepare(plan_.tasks[i]);
      processes.push_back(plan_.tasks[i].process);
      names.push_back(plan_.tasks[i].workload.name());
    }
    ProcessPool pool(std::move(processes), limits_);
    BenchView view(terminal_, is_live_, chosen_.size());
    pool.on_time = [&] { view.draw(pool, names); };
    pool.on_end = [&](size_t index) { take(chosen_[index], pool.processes()[index], view, directory); };
    const int signal = pool.run();
    for (size_t k = 0; k < chosen_.size(); ++k)
      plan_.tasks[chosen_[k]].process.state = pool.processes()[k].state;
    return signal;
  }

  // Handles a process that has ended: prints its figures, marks it, and writes the metrics up to now.
  void take(size_t index, const Process& process, BenchView& view, const report::RunDirectory& directory) {
    BenchTask& task = plan_.tasks[index];
    task.process = process;
    std::string figures = process.state == Process::State::Stopped
                              ? "stopped"
                              : fmt::format("FAILED, {}: {}", process.end, last_words(process.log));
    if (process.state == Process::State::Done) {
      const report::RunRecord record = report::RunRecord::read(task.directory);
      figures = figures_of(record);
      set_row(task, record);
      mark_complete(task, plan_.key, process);
      write_metrics(directory);
    }
    // A row of metrics.csv stands for a whole launch, so a partial one has none.
    if (process.state == Process::State::Partial)
      figures = figures_of(report::RunRecord::read(task.directory));
    view.ended(task, task.process, figures);
  }

  std::vector<BenchRow> rows() const {
    std::vector<BenchRow> out;
    for (const BenchTask& task : plan_.tasks)
      if (task.process.state == Process::State::Done || task.process.state == Process::State::Partial)
        out.push_back({&task, &task.process, report::RunRecord::read(task.directory)});
    return out;
  }

  void write_metrics(const report::RunDirectory& directory) const {
    directory.write("metrics.csv", table_.text());
    write_record(directory);
  }

  // Lists the tables, so that readers notice a damaged one.
  void write_record(const report::RunDirectory& directory) const {
    report::FileList list = directory.written();
    list.erase(kBenchRecord);
    directory.write(kBenchRecord, bench_record(list));
  }

  Exit conclude(const report::RunDirectory& directory, int signal) const {
    size_t done = 0, failed = 0;
    std::string names, partial;
    for (const BenchTask& task : plan_.tasks) {
      done += task.process.state == Process::State::Done;
      if (task.process.state == Process::State::Partial) partial += " " + task.workload.name();
      if (task.process.state != Process::State::Failed) continue;
      ++failed;
      names += " " + task.workload.name();
    }
    const std::string table = summary_table(rows());
    directory.write("summary.txt", table);
    std::error_code ignored;  // The file may not exist.
    std::filesystem::remove(directory.path_of(kEstimates), ignored);
    if (const std::string estimates = estimates_table(rows()); !estimates.empty())
      directory.write(kEstimates, estimates);
    write_record(directory);
    print_output("\n{}\n{} of {} workloads complete, metrics in {}\n", table, done, plan_.tasks.size(),
                 directory.path_of("metrics.csv"));
    if (failed)
      fmt::print(stderr, "error: {} failed:{}\n  note: log.txt in the directory of each says why\n", failed,
                 names);
    if (signal)
      fmt::print(
          stderr,
          "error: the bench was interrupted\n  note: the same command with --resume goes on from here\n");
    if (!partial.empty())
      fmt::print(
          stderr,
          "error: --max-cycles has ended these launches, which metrics.csv does not have:{}\n  note: the "
          "directory of each holds what it did up to then\n",
          partial);
    if (signal) return Exit(exit_code_of(signal));
    if (failed) return Exit::Failure;
    return partial.empty() ? Exit::Ok : kReachedMaxCycles;
  }

  const BenchOptions& options_;
  std::vector<std::string> command_;
  BenchPlan plan_;
  MetricsTable table_;
  PoolLimits limits_;
  std::vector<size_t> chosen_;  // tasks to run; the others are complete
  bool is_live_;
  report::Terminal terminal_;
};

}  // namespace

Exit run_bench(const Session& session, const BenchOptions& options) {
  return Bench(session, options).run();
}

}  // namespace glint::app
