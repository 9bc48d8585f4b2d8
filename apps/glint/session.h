// What every subcommand needs: the command line, where resources lie, what the terminal can, what to run.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "apps/glint/options/resources.h"
#include "base/diagnostics.h"
#include "report/terminal/table.h"

namespace CLI {
class App;
}

namespace glint::app {

struct Session {
  std::vector<std::string> arguments;  // argv
  Resources resources;
  report::Terminal terminal;     // of stdout
  bool on_terminal = false;      // stdout is one: progress may be drawn
  bool can_move_cursor = false;  // and it knows escape sequences
  int progress_descriptor = -1;  // where a process that started this one listens; -1 = nowhere
  std::function<Exit()> action;  // set by the subcommand that was chosen
};

// Each adds its subcommand; its callback sets Session::action.
void add_run(CLI::App& app, Session& session);
void add_bench(CLI::App& app, Session& session);
void add_stats(CLI::App& app, Session& session);
void add_report(CLI::App& app, Session& session);
void add_characterize(CLI::App& app, Session& session);
void add_compare(CLI::App& app, Session& session);
void add_imgdiff(CLI::App& app, Session& session);
void add_annotate(CLI::App& app, Session& session);
void add_model(CLI::App& app, Session& session);
void add_init(CLI::App& app, Session& session);
void add_compile(CLI::App& app, Session& session);
void add_asm(CLI::App& app, Session& session);
void add_isa(CLI::App& app, Session& session);
void add_list(CLI::App& app, Session& session);
void add_microbench(CLI::App& app, Session& session);
void add_describe(CLI::App& app, Session& session);

}  // namespace glint::app
