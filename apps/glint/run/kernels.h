// Holds what the launches of a kernel's launch file share: memory, buffers, and compiled kernels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "apps/glint/run/launch_file.h"
#include "apps/glint/run/launch_options.h"
#include "pipeline/kernel_launch.h"
#include "report/files/run_directory.h"

namespace glint::app {

// All launches have one memory. Launches of kernels of the same file share the variables of the module, too.
class Kernels {
 public:
  // Compiles the kernels, places the buffers, and checks all launches. Throws UserError that names the place
  // in the launch file, which lies at `path`. What kernels print goes to `prints`; null: nowhere.
  Kernels(const LaunchFile& file, const std::string& path, const pipeline::GpuParams& gpu,
          const LaunchOptions& options, exec::PrintLog* prints = nullptr);

  // Returns the world of a launch with its grid and arguments. It is overwritten by the next launch of the
  // same kernel.
  exec::World& prepare(size_t launch);
  // Returns the name of a launch's kernel.
  const std::string& name(size_t launch) { return world_of(file_.launches[launch]).kernel().program.name; }
  // Returns the PTX of all kernels, one after another.
  const std::string& text() const { return text_; }
  // Returns lines on the buffers that the launch file asks for, and writes those to save into the run
  // directory.
  std::vector<std::string> keep_buffers(const report::RunDirectory& directory) const;
  // Adds to `info` which buffers are saved.
  void describe_saved(report::RunInfo& info) const;

 private:
  void compile(const KernelLaunch& launch, const pipeline::GpuParams& gpu, exec::OnFault on_fault,
               exec::PrintLog* prints);
  pipeline::KernelWorld& world_of(const KernelLaunch& launch);

  using Key = std::tuple<std::string, std::string, bool>;  // kernel, entry, contract
  const LaunchFile& file_;
  const std::string path_;
  std::shared_ptr<mem::AddressSpace> memory_ = std::make_shared<mem::AddressSpace>();
  std::vector<exec::ImageView> images_;
  std::map<std::string, pipeline::ModuleVariables> variables_;  // by file
  std::map<Key, std::unique_ptr<pipeline::KernelWorld>> worlds_;
  std::vector<std::vector<Address>> buffers_;  // by launch and argument; 0 for numbers
  std::string text_;
};

}  // namespace glint::app
