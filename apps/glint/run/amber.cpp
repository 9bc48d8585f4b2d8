// Running scripts one after the other and counting what comes out.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/amber.h"

#include <cstdio>
#include <fmt/format.h>

#include "amber/run.h"
#include "apps/glint/options/config.h"

namespace glint::app {

bool names_script(const std::string& what) {
  return what.ends_with(".amber");
}

Exit run_amber(const Session& session, const AmberOptions& options) {
  for (const std::string& path : options.scripts)
    if (!names_script(path))
      throw UserError({}, fmt::format("'{}' is no Amber script", path),
                      "several names on one command line are all FILE.amber");
  amber::LaunchOptions launch;
  launch.gpu = read_config(session.resources, options.config, options.settings);
  if (options.max_instructions > 0) launch.gpu.core.instruction_budget = options.max_instructions;
  launch.timing = options.timing, launch.no_skip = options.no_skip, launch.threads = options.threads,
  launch.on_fault = options.on_fault;
  const std::unique_ptr<frontend::ShaderCache> cache = open_shader_cache(options.shaders);
  exec::PrintLog prints(options.print_limit);
  launch.cache = cache.get(), launch.prints = &prints;

  uint32_t counts[3] = {};
  Exit exit = Exit::Ok;
  for (const std::string& path : options.scripts) {
    const amber::Outcome outcome = amber::run_script(path, launch);
    ++counts[size_t(outcome.verdict)];
    fmt::print(stderr, "{}", outcome.printed);
    for (const std::string& faults : outcome.faults) fmt::print(stderr, "{}\n", faults);
    if (outcome.verdict != amber::Verdict::Passed) fmt::print(stderr, "{}\n", outcome.message);
    if (options.scripts.size() == 1) exit = outcome.exit;
    if (options.timing && outcome.verdict == amber::Verdict::Passed)
      print_output("{}: {} cycles\n", path, outcome.cycles);
  }
  print_output("{} passed, {} failed, {} unsupported\n", counts[0], counts[1], counts[2]);
  if (options.scripts.size() > 1) exit = counts[1] ? Exit::Failure : counts[2] ? Exit::Unsupported : Exit::Ok;
  return exit;
}

}  // namespace glint::app
