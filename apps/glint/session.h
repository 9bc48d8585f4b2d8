// Holds what every subcommand needs: command line, resources, abilities of the terminal, and the action to
// run.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "apps/glint/options/command_line.h"
#include "apps/glint/options/plugins.h"
#include "base/diagnostics.h"
#include "report/terminal/table.h"
#include "setup/resources.h"

namespace glint::app {

struct Session {
  std::vector<std::string> arguments;  // argv
  setup::Resources resources;
  std::vector<Plugin> plugins;   // loaded, in order
  report::Terminal terminal;     // abilities of stdout
  bool on_terminal = false;      // Stdout is a terminal, so progress may be drawn.
  bool can_move_cursor = false;  // The terminal knows escape sequences.
  int progress_descriptor = -1;  // where a process that started this one listens; -1: nowhere
  std::function<Exit()> action;  // The subcommand that was chosen sets it.
  // `run` sets it, too: it throws UserError when the action would refuse how options go together.
  std::function<void()> check{};
};

// Each function adds its subcommand, whose callback sets Session::action.
void add_run(Command app, Session& session);
void add_vulkan(Command app, Session& session);
void add_export(Command app, Session& session);
void add_bench(Command app, Session& session);
void add_lab(Command app, Session& session);
void add_ablate(Command app, Session& session);
void add_paper(Command app, Session& session);
void add_sweep(Command app, Session& session);
void add_stats(Command app, Session& session);
void add_report(Command app, Session& session);
void add_characterize(Command app, Session& session);
void add_compare(Command app, Session& session);
void add_imgdiff(Command app, Session& session);
void add_annotate(Command app, Session& session);
void add_model(Command app, Session& session);
void add_init(Command app, Session& session);
void add_compile(Command app, Session& session);
void add_asm(Command app, Session& session);
void add_isa(Command app, Session& session);
void add_list(Command app, Session& session);
void add_microbench(Command app, Session& session);
void add_describe(Command app, Session& session);

}  // namespace glint::app
