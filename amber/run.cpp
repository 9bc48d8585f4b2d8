// Runs the commands of a script one after the other, up to the first that fails.
// SPDX-License-Identifier: Apache-2.0
#include "amber/run.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fmt/format.h>
#include <map>

#include "amber/expect.h"
#include "pipeline/software_traversal.h"

namespace glint::amber {
namespace {

class Runner {
 public:
  Runner(Script& script, const LaunchOptions& options, Outcome& outcome)
      : script_(script),
        options_(options),
        outcome_(outcome),
        device_(options.gpu),
        memory_(script, options_.gpu.bvh) {}

  // Returns false when an expectation does not hold or a launch was ended early.
  bool run(const std::vector<Command>& commands) {
    for (const Command& command : commands)
      if (!run(command)) return false;
    return true;
  }

 private:
  bool run(const Command& command) {
    switch (command.kind) {
      case Command::Kind::Run:
        return launch_pipeline(command);
      case Command::Kind::Copy:
        return copy(command), true;
      case Command::Kind::Write:
        std::copy(command.bytes.begin(), command.bytes.end(),
                  script_.buffers.at(command.to).bytes.begin() + std::ptrdiff_t(command.offset));
        memory_.buffers.update(script_.buffers.at(command.to));
        return true;
      case Command::Kind::Repeat:
        for (uint32_t i = 0; i < command.count; ++i)
          if (!run(command.body)) return false;
        return true;
      case Command::Kind::Expect:
        break;
    }
    ++outcome_.expectations;
    const std::string difference = check(script_, command);
    if (difference.empty()) return true;
    outcome_.verdict = Verdict::Failed, outcome_.exit = Exit::Failure;
    outcome_.message = fmt::format("{}: failed: {}", command.where.to_string(), difference);
    return false;
  }

  const CompiledPipeline& code_of(const std::string& name) {
    const auto found = compiled_.find(name);
    if (found != compiled_.end()) return found->second;
    return compiled_
        .try_emplace(name,
                     compile(script_, script_.pipelines.at(name), pipeline::compiler_for(options_.gpu),
                             options_.cache),
                     options_)
        .first->second;
  }

  bool launch_pipeline(const Command& command) {
    try {
      const Launched launched =
          launch(script_, command, code_of(command.pipeline), memory_, device_, options_, outcome_.launches);
      keep_prints();
      outcome_.launches += launched.is_launch;
      outcome_.cycles += launched.cycles;
      if (!launched.faults.empty())
        outcome_.faults.push_back(
            fmt::format("{}: {}", command.where.to_string(), launched.faults.to_string()));
      if (launched.end == pipeline::LaunchEnd::Whole) return true;
    } catch (const Error& error) {
      keep_prints();
      if (error.exit() != Exit::Fault && error.exit() != Exit::Stuck) throw;
      throw Error(error.exit(), fmt::format("{}: {}", command.where.to_string(), error.what()));
    }
    outcome_.verdict = Verdict::Failed, outcome_.exit = Exit::Failure;
    outcome_.message = fmt::format("{}: the launch was ended early", command.where.to_string());
    return false;
  }

  void keep_prints() {
    if (options_.prints) outcome_.printed += options_.prints->take();
  }

  void copy(const Command& command) {
    const Buffer& from = script_.buffers.at(command.from);
    Buffer& to = script_.buffers.at(command.to);
    to.bytes = from.bytes, to.elements = from.elements, to.size = from.size, to.levels = from.levels;
    memory_.buffers.update(to);
  }

  Script& script_;
  const LaunchOptions& options_;
  Outcome& outcome_;
  pipeline::Device device_;
  ScriptMemory memory_;
  std::map<std::string, CompiledPipeline> compiled_;  // by name of the pipeline
};

}  // namespace

void note(Outcome& outcome, const Error& error) {
  outcome.verdict = error.exit() == Exit::Unsupported ? Verdict::Unsupported : Verdict::Failed;
  outcome.exit = error.exit();
  outcome.message = error.what();
}

Outcome run_script(Script script, const LaunchOptions& options) {
  Outcome outcome;
  try {
    Runner(script, options, outcome).run(script.commands);
  } catch (const Error& error) {
    note(outcome, error);
  }
  return outcome;
}

Outcome run_script(const std::string& path, const LaunchOptions& options) {
  try {
    return run_script(read_script(path), options);
  } catch (const Error& error) {
    Outcome outcome;
    note(outcome, error);
    return outcome;
  }
}

}  // namespace glint::amber
