// Compiles the kernels of a launch file and gives each launch its arguments.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/kernels.h"

#include <algorithm>
#include <cstddef>
#include <fmt/format.h>
#include <optional>
#include <utility>

#include "apps/glint/run/kernel_images.h"
#include "report/files/config_file.h"
#include "setup/resources.h"

namespace glint::app {
namespace {

std::string read_text(const std::string& path, const SourceLocation& where) {
  std::optional<std::string> text = setup::text_of_file(path);
  if (!text) throw UserError(where, fmt::format("cannot read the kernel '{}'", path));
  return std::move(*text);
}

}  // namespace

Kernels::Kernels(const LaunchFile& file, const std::string& path, const pipeline::GpuParams& gpu,
                 const LaunchOptions& options, exec::PrintLog* prints)
    : file_(file), path_(path), images_(place_images(file.images, *memory_, host_threads(options.threads))) {
  std::map<std::string, Address> known;
  for (const KernelLaunch& launch : file.launches) {
    compile(launch, gpu, options.on_fault, prints);
    std::vector<Address>& addresses = buffers_.emplace_back();
    for (const LaunchArgument& argument : launch.arguments) {
      addresses.push_back(argument.is_known ? known.at(argument.name) : 0);
      if (!argument.is_buffer || argument.is_known) continue;
      const Address at = memory_->allocate(argument.name, std::max<size_t>(argument.bytes.size(), 1));
      memory_->write(at, argument.bytes.data(), argument.bytes.size());
      addresses.back() = known[argument.name] = at;
    }
  }
  for (size_t i = 0; i < file.launches.size(); ++i) prepare(i);
}

void Kernels::compile(const KernelLaunch& launch, const pipeline::GpuParams& gpu, exec::OnFault on_fault,
                      exec::PrintLog* prints) {
  std::unique_ptr<pipeline::KernelWorld>& made = worlds_[{launch.kernel, launch.entry, launch.contract}];
  if (made) return;
  const std::string text = read_text(launch.kernel, launch.kernel_where);
  frontend::PtxOptions compiler = pipeline::ptx_options(gpu.compiler, launch.contract);
  compiler.heap_bytes = launch.heap_bytes;
  made = std::make_unique<pipeline::KernelWorld>(
      frontend::compile_ptx(text, launch.kernel, launch.entry, compiler), memory_,
      &variables_[launch.kernel]);
  made->world.prints = prints;
  made->world.images = images_;
  made->world.on_fault = on_fault;
  made->world.layout = gpu.core.layout.make({});
  text_ += text;
}

pipeline::KernelWorld& Kernels::world_of(const KernelLaunch& launch) {
  return *worlds_.at({launch.kernel, launch.entry, launch.contract});
}

exec::World& Kernels::prepare(size_t launch) {
  const KernelLaunch& from = file_.launches[launch];
  pipeline::KernelWorld& kernel = world_of(from);
  const std::vector<frontend::KernelParameter>& parameters = kernel.kernel().parameters;
  if (parameters.size() != from.arguments.size())
    throw UserError({path_, from.where.line, from.where.column},
                    fmt::format("kernel '{}' has {} parameters, and the file gives {} arguments",
                                kernel.kernel().program.name, parameters.size(), from.arguments.size()));
  std::vector<std::vector<std::byte>> values;
  for (size_t i = 0; i < parameters.size(); ++i) {
    const LaunchArgument& argument = from.arguments[i];
    values.push_back(argument.is_buffer ? pipeline::KernelWorld::argument(buffers_[launch][i])
                                        : argument.bytes);
    if (values.back().size() != parameters[i].bytes)
      throw UserError(argument.where,
                      fmt::format("parameter '{}' has {} bytes, and this argument has {}", parameters[i].name,
                                  parameters[i].bytes, values.back().size()));
  }
  kernel.set_grid(from.grid);
  kernel.set_arguments(values);
  return kernel.world;
}

std::vector<std::string> Kernels::keep_buffers(const report::RunDirectory& directory) const {
  std::vector<std::string> lines;
  for (size_t launch = 0; launch < file_.launches.size(); ++launch)
    for (size_t i = 0; i < file_.launches[launch].arguments.size(); ++i) {
      const LaunchArgument& argument = file_.launches[launch].arguments[i];
      if (!argument.is_buffer || argument.is_known || (!argument.save && argument.show == 0)) continue;
      const size_t bytes = argument.bytes.size();
      const std::byte* data = memory_->find(buffers_[launch][i], bytes);
      const std::string raw(reinterpret_cast<const char*>(data), bytes);
      std::string line =
          fmt::format("{:<10} {} bytes, fnv1a {:016x}", argument.name, bytes, report::fnv1a(raw));
      if (argument.save) {
        directory.write(argument.name + ".bin", raw);
        line += ", " + directory.path_of(argument.name + ".bin");
      }
      if (argument.show > 0)
        line += "\n             " + first_values(argument.type, data, bytes, argument.show);
      lines.push_back(std::move(line));
    }
  for (std::string& line : keep_images(file_.images, images_, *memory_, directory, 1))
    lines.push_back(std::move(line));
  return lines;
}

void Kernels::describe_saved(report::RunInfo& info) const {
  for (const KernelLaunch& launch : file_.launches)
    for (const LaunchArgument& argument : launch.arguments)
      if (argument.is_buffer && !argument.is_known && argument.save) {
        info.saved.push_back(argument.name + ".bin");
        info.outputs.push_back({argument.name + ".bin", argument.name});
      }
}

}  // namespace glint::app
