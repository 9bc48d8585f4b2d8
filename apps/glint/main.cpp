// Runs the command `glint`: reads the command line, runs one subcommand, and turns errors into exit codes.
// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <fmt/format.h>
#include <new>
#include <string>
#include <system_error>
#include <unistd.h>
#include <vector>

#include "apps/glint/options/command_line.h"
#include "apps/glint/options/output.h"
#include "apps/glint/options/plugins.h"
#include "apps/glint/options/suggest.h"
#include "apps/glint/session.h"
#include "base/check.h"
#include "base/diagnostics.h"
#include "base/registry.h"
#include "setup/resources.h"

namespace glint::app {
namespace {

bool is_utf8(const char* locale) {
  const std::string name = locale;
  return name.find("UTF-8") != std::string::npos || name.find("utf8") != std::string::npos;
}

// Returns whether the locale is UTF-8. By POSIX, LC_ALL wins over LC_CTYPE, which wins over LANG; an empty
// variable counts as unset.
bool locale_is_utf8() {
  for (const char* variable : {"LC_ALL", "LC_CTYPE", "LANG"})
    if (const char* value = std::getenv(variable); value && *value) return is_utf8(value);
  return false;
}

void look_at_terminal(Session& session) {
  const char* no_colour = std::getenv("NO_COLOR");  // by no-color.org, any non-empty value counts
  const char* kind = std::getenv("TERM");
  session.on_terminal = ::isatty(STDOUT_FILENO) != 0;
  session.terminal.utf8 = session.on_terminal && locale_is_utf8();
  session.can_move_cursor = session.on_terminal && kind && std::string(kind) != "dumb";
  session.terminal.colour =
      session.on_terminal && !(no_colour && *no_colour) && kind && std::string(kind) != "dumb";
}

// Replaces closed descriptors. A closed one would be given to the next file that is opened, and what is
// printed would go into that file. Afterwards writes to a closed stdout fail, and writes to a closed stderr
// have no effect.
void keep_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(descriptor, F_GETFD) == -1)
      ::open("/dev/null", descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY);
}

// Lets a write beyond the limit on the size of files (`ulimit -f`) fail with a reason. By default a signal
// ends the process without one, and its half file stays.
void keep_writing_errors() {
  std::signal(SIGXFSZ, SIG_IGN);
}

int report_parse_error(const Command& command, const std::string& error, const Session& session) {
  fmt::print(stderr, "error: {}\n", error);
  const std::string hint = suggestion(command, session.arguments);
  fmt::print(stderr, "  note: {}\n",
             hint.empty() ? "'glint --help' and 'glint COMMAND --help' list all commands and options" : hint);
  return int(Exit::UserInput);
}

int run_action(Session& session, const std::vector<std::string>& plugin_files) {
  try {
    GLINT_CHECK(registered_twice().empty(), "two policies have one name: {}", registered_twice().front());
    session.plugins = load_plugins(plugin_files);
    return int(session.action());
  } catch (const Error& error) {
    fmt::print(stderr, "{}{}\n",
               std::string(error.what()).find("error: ") == std::string::npos ? "error: " : "", error.what());
    return int(error.exit());
  } catch (const std::bad_alloc&) {
    fmt::print(stderr,
               "error: out of memory\n  note: a smaller --size or a smaller scene needs less memory\n");
    return int(Exit::Failure);
  }
}

int main_of(int argc, char** argv) {
  Session session{.arguments = {argv, argv + argc},
                  .resources = setup::Resources::find(),
                  .plugins = {},
                  .terminal = {},
                  .action = {}};
  look_at_terminal(session);
  CommandLine line(
      "Glint is a GPU you can read. It runs ray-tracing shaders on a simulated GPU and says what the GPU "
      "did, cycle by cycle.",
      "glint", GLINT_VERSION);
  const Command app = line.command();
  std::vector<std::string> plugin_files;
  add_plugin_option(app, plugin_files);
  add_run(app, session);
  add_vulkan(app, session);
  add_export(app, session);
  add_bench(app, session);
  add_lab(app, session);
  add_ablate(app, session);
  add_sweep(app, session);
  add_paper(app, session);
  add_stats(app, session);
  add_report(app, session);
  add_characterize(app, session);
  add_compare(app, session);
  add_imgdiff(app, session);
  add_annotate(app, session);
  add_model(app, session);
  add_init(app, session);
  add_compile(app, session);
  add_asm(app, session);
  add_isa(app, session);
  add_list(app, session);
  add_microbench(app, session);
  add_describe(app, session);
  const ParseOutcome outcome = line.parse(argc, argv);
  if (!outcome.error.empty()) return report_parse_error(app, outcome.error, session);
  if (outcome.is_done) {
    write_output("", outcome.text);
    return int(Exit::Ok);
  }
  return run_action(session, plugin_files);
}

// Catches what the machine may refuse anywhere: a stderr that takes no more, a thread that cannot be started,
// a folder that cannot be read.
int guarded_main(int argc, char** argv) {
  try {
    keep_descriptors();
    keep_writing_errors();
    return main_of(argc, argv);
  } catch (const OutputError& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return int(error.exit());
  } catch (const std::system_error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return int(Exit::Failure);
  }
}

}  // namespace
}  // namespace glint::app

int main(int argc, char** argv) {
  return glint::app::guarded_main(argc, argv);
}
