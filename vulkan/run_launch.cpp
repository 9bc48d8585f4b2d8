// Runs a launch of any kind on the machine that the user has chosen for it, and tells and records what it
// did.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/run_launch.h"

#include <exception>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <optional>
#include <string_view>
#include <vector>

#include "pipeline/render.h"
#include "report/files/config_file.h"
#include "vulkan/device.h"
#include "vulkan/process.h"

namespace glint::vulkan {
namespace {

// Returns a number for the work of a launch, by which comparisons of runs tell whether it is the same.
uint64_t hash_of(const LaunchOf& launch) {
  std::string text;
  for (const PipelineStage& stage : launch.pipeline.stages) {
    const std::vector<uint32_t>& words = *stage.words;
    text.append(reinterpret_cast<const char*>(words.data()), words.size() * sizeof(uint32_t));
    text += stage.entry_point;
    for (const auto& [id, value] : stage.constants) text += fmt::format(" {}={}", id, value);
  }
  text += fmt::format("{} {}", launch.kind, fmt::join(launch.size, " "));
  return report::fnv1a(text);
}

// Runs one launch and adds what it did to its line of the index.
class Launching {
 public:
  Launching(Queue& queue, const LaunchOf& launch, const exec::World& world, exec::PrintLog& prints)
      : device_(queue.device), launch_(launch), world_(world), prints_(prints) {
    command_.kind = launch.kind, command_.shader = launch.pipeline.name, command_.size = launch.size;
    command_.number = device_.launches.all++;
    command_.label = fmt::format("{}", fmt::join(queue.labels, " / "));
    command_.begin = device_.clock.now(), command_.frame = device_.frames;
    const setup::LaunchFacts facts{launch.kind,          command_.number,
                                   command_.frame,       launch.pipeline.launches++,
                                   launch.pipeline.name, queue.labels};
    const Settings& settings = device_.physical.instance.settings;
    mode_.timing = settings.timing.takes(facts), mode_.threads = settings.threads;
    if (mode_.timing) mode_.observe = settings.observe;
    if (settings.save.takes(facts)) capsule_ = launch.save();
  }

  void run() {
    try {
      run_unsaved();
    } catch (...) {
      save();
      throw;
    }
    save();
  }

 private:
  void run_unsaved() {
    if (mode_.timing) return run_timed();
    try {
      const pipeline::RenderResult result = device_.gpu.run(world_, mode_, {});
      device_.clock.add_launch(result.warp_instructions);
      take_prints();
      end(result);
    } catch (const std::exception& error) {
      command_.error = error.what(), command_.end = device_.clock.now();
      device_.recording.add(command_);
      throw;
    }
    device_.recording.add(command_);
  }

  void save() {
    if (!capsule_) return;
    capsule_->program = program_of_process(), capsule_->kind = command_.kind;
    capsule_->shader = command_.shader, capsule_->label = command_.label;
    capsule_->number = command_.number, capsule_->frame = command_.frame;
    capsule_->hash = hash_of(launch_), capsule_->config = device_.physical.instance.settings.preset;
    capsule_->cycles = command_.cycles;
    device_.recording.add_capsule(*capsule_);
  }

  void run_timed() {
    pipeline::LaunchWatch watch;
    watch.progress = [this](const pipeline::LaunchProgress& progress, const auto&) {
      device_.recording.tell_progress(command_, progress);
    };
    device_.recording.run(command_, {.hash = hash_of(launch_),
                                     .observe = mode_.observe,
                                     .threads = world_.launch_size,
                                     .launch = [&] { return device_.gpu.run(world_, mode_, watch); },
                                     .ended =
                                         [this](const pipeline::RenderResult& result) {
                                           count(result);
                                           end(result);
                                         },
                                     .take_prints = [this] { return take_prints(); }});
  }

  void count(const pipeline::RenderResult& result) {
    device_.clock.add_timed_launch(result.cycles);
    ++device_.launches.timed, device_.launches.cycles += result.cycles;
    command_.cycles = result.cycles;
    device_.messages().info(
        fmt::format("{} {}: {}, {} cycles", command_.kind, command_.number, command_.shader, result.cycles));
  }

  void end(const pipeline::RenderResult& result) {
    command_.end = device_.clock.now(), command_.instructions = result.warp_instructions;
    for (const exec::FaultLog::Entry& each : result.faults.in_order()) command_.faults += each.count;
    if (result.faults.empty()) return;
    const std::string label = command_.label.empty() ? "" : fmt::format(", label '{}'", command_.label);
    device_.messages().warning(
        fmt::format("launch of {}{}:\n{}", command_.shader, label, result.faults.to_string()));
  }

  std::string take_prints() {
    std::string text = prints_.take();
    if (!text.empty()) device_.messages().info(text);
    return text;
  }

  Device& device_;
  const LaunchOf& launch_;
  const exec::World& world_;
  exec::PrintLog& prints_;
  pipeline::LaunchMode mode_;
  report::DeviceCommand command_;
  std::optional<pipeline::Capsule> capsule_;  // nothing: the launch is not saved
};

}  // namespace

void run_launch(Queue& queue, const LaunchOf& launch, const exec::World& world, exec::PrintLog& prints) {
  Launching(queue, launch, world, prints).run();
}

}  // namespace glint::vulkan
