// Compiles kernels once, launches them and compares buffers.
// SPDX-License-Identifier: Apache-2.0
#include "compute/host.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <utility>

#include "base/regular_file.h"

namespace glint::compute {
namespace {

struct EndedEarly {};  // leaves a program whose launch the watch has ended

// A contracted kernel rounds once where the reference rounds twice, again and again over a program.
constexpr double kContractTolerance = 1e-3;

}  // namespace

struct Host::Kernel {
  Kernel(pipeline::CompiledStage stage, const HostSetup& setup)
      : shaders({stage.program}, stage.reflection.bindings, setup.gpu, setup.cache) {}
  pipeline::LinkedShaders shaders;
};

Host::Host(HostSetup setup) : setup_(std::move(setup)), device_(setup_.gpu) {
  setup_.mode.caches = pipeline::Caches::Warm;
}

Host::~Host() = default;

const Host::Kernel& Host::kernel(const std::string& name) {
  std::unique_ptr<Kernel>& kernel = kernels_[name];
  if (kernel) return *kernel;
  const std::string file = setup_.kernels + "/" + name + ".comp";
  frontend::GlslOptions glsl;
  glsl.cache = setup_.cache;
  Diagnostics notes;
  pipeline::StageSource source{file, "", {}, frontend::Validity::Known};
  kernel = std::make_unique<Kernel>(pipeline::compile_stage(frontend::spirv_of_file(file, glsl), source,
                                                            setup_.gpu.compiler, notes, setup_.cache),
                                    setup_);
  return *kernel;
}

void Host::launch(const std::string& name, const std::array<uint32_t, 3>& groups,
                  const std::vector<pipeline::BufferRange>& buffers, std::span<const std::byte> constants) {
  pipeline::LaunchBuilder builder(kernel(name).shaders, memory_);
  for (uint32_t i = 0; i < buffers.size(); ++i) builder.bind_buffers({0, i}, {buffers[i]});
  builder.set_push_constants(constants);
  builder.set_blocks(0, groups);
  builder.world.on_fault = setup_.on_fault;
  builder.world.prints = setup_.prints;
  run(name, groups, builder.finish());
  for (const Address at : builder.allocations()) memory_.free(at);
}

void Host::launch_ptx(const std::string& name, const pipeline::KernelGrid& grid,
                      const std::vector<std::vector<std::byte>>& arguments) {
  const std::string file = setup_.kernels + "/" + name + ".ptx";
  const std::optional<std::string> text = read_regular_file(file);
  if (!text) throw UserError({file}, "the kernel cannot be read");
  const frontend::PtxOptions options{.backend = pipeline::backend_options(setup_.gpu.compiler)};
  pipeline::KernelWorld kernel(frontend::compile_ptx(*text, file, "", options));
  kernel.world.memory = &memory_;
  kernel.world.layout = setup_.gpu.core.layout.make({});
  kernel.world.on_fault = setup_.on_fault;
  kernel.set_grid(grid);
  kernel.set_arguments(arguments);
  run(name, grid.grid, kernel.world);
}

void Host::run(const std::string& kernel, const std::array<uint32_t, 3>& groups, const exec::World& world) {
  pipeline::RenderResult result =
      setup_.run ? setup_.run(world) : device_.run(world, setup_.mode, setup_.watch);
  launches_.push_back({kernel, groups, result.cycles, result.warp_instructions, result.lane_instructions});
  const pipeline::LaunchEnd end = result.end;
  if (launches_.size() == 1)
    sum_ = std::move(result);
  else
    sum_.add(result);
  if (end != pipeline::LaunchEnd::Whole) throw EndedEarly{};
}

void Host::check_count(const std::string& name, size_t got, size_t expected) {
  if (got != expected)
    throw WrongResult(
        fmt::format("error: '{}' has {} values, and the reference has {}", name, got, expected));
  checked_ += expected;
}

bool Host::is_near(double got, double expected, bool exact, double tolerance) const {
  if (exact) return false;
  if (setup_.gpu.compiler.contract) tolerance = std::max(tolerance, kContractTolerance);
  return std::abs(got - expected) <= tolerance * std::max(1.0, std::abs(expected));
}

void Host::wrong(const std::string& name, size_t index, double got, double expected) {
  throw WrongResult(fmt::format("error: value {} of '{}' is {}, and the reference computes {}", index, name,
                                got, expected));
}

ProgramResult run_program(const Program& program, Size size, HostSetup setup) {
  Host host(std::move(setup));
  ProgramResult out;
  try {
    program.run(host, size);
    out.checked = host.checked();
  } catch (const EndedEarly&) {  // Nothing is checked then.
  }
  out.launches = host.launches();
  out.sum = host.take_result();
  return out;
}

}  // namespace glint::compute
