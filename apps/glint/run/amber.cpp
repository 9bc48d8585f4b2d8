// Runs scripts one after the other and counts their results.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/amber.h"

#include <cstdio>
#include <fmt/format.h>
#include <memory>

#include "amber/run.h"
#include "apps/glint/options/output.h"

namespace glint::app {

bool names_script(const std::string& what) {
  return what.ends_with(".amber");
}

Exit run_amber(const Session& session, const std::vector<std::string>& scripts, const LaunchOptions& options,
               bool strict) {
  for (const std::string& path : scripts)
    if (!names_script(path))
      throw UserError({}, fmt::format("'{}' is not an Amber script", path),
                      "several names on one command line must all be FILE.amber");
  amber::LaunchOptions launch;
  launch.gpu = gpu_of(session.resources, options);
  launch.timing = options.mode_given && options.mode == "timing", launch.no_skip = options.no_skip,
  launch.threads = options.threads, launch.on_fault = options.on_fault, launch.strict = strict;
  const std::unique_ptr<frontend::ShaderCache> cache = open_shader_cache(options.shaders);
  exec::PrintLog prints(options.print_limit);
  launch.cache = cache.get(), launch.prints = &prints;

  uint32_t counts[3] = {};
  Exit exit = Exit::Ok;
  for (const std::string& path : scripts) {
    const amber::Outcome outcome = amber::run_script(path, launch);
    ++counts[size_t(outcome.verdict)];
    fmt::print(stderr, "{}", outcome.printed);
    for (const std::string& faults : outcome.faults) fmt::print(stderr, "{}\n", faults);
    if (outcome.verdict != amber::Verdict::Passed) fmt::print(stderr, "{}\n", outcome.message);
    if (scripts.size() == 1) exit = outcome.exit;
    if (launch.timing && outcome.verdict == amber::Verdict::Passed)
      print_output("{}: {} cycles\n", path, outcome.cycles);
  }
  print_output("{} passed, {} failed, {} unsupported\n", counts[0], counts[1], counts[2]);
  if (scripts.size() > 1) exit = counts[1] ? Exit::Failure : counts[2] ? Exit::Unsupported : Exit::Ok;
  return exit;
}

}  // namespace glint::app
