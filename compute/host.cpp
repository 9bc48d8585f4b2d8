// Compiles kernels once, launches them and compares buffers.
// SPDX-License-Identifier: Apache-2.0
#include "compute/host.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace glint::compute {
namespace {

struct EndedEarly {};  // leaves a program whose launch the watch has ended

// A contracted kernel rounds once where the reference rounds twice, again and again over a program.
constexpr double kContractTolerance = 1e-3;

}  // namespace

Host::Host(HostSetup setup, Form form) : setup_(std::move(setup)), form_(form), device_(setup_.gpu) {
  setup_.mode.caches = pipeline::Caches::Warm;
}

Host::~Host() = default;

Kernel& Host::kernel(const std::string& name) {
  std::unique_ptr<Kernel>& kernel = kernels_[name];
  if (!kernel) kernel = compile_kernel(setup_.kernels + "/" + name, form_, setup_.gpu, setup_.cache, memory_);
  return *kernel;
}

void Host::launch(const std::string& name, const std::array<uint32_t, 3>& groups,
                  const std::vector<pipeline::BufferRange>& buffers, std::span<const std::byte> constants) {
  kernel(name).launch({groups, buffers, constants}, [&](exec::World& world) {
    world.on_fault = setup_.on_fault;
    world.prints = setup_.prints;
    run(name, groups, world);
  });
}

void Host::run(const std::string& kernel, const std::array<uint32_t, 3>& groups, const exec::World& world) {
  pipeline::RenderResult result =
      setup_.run ? setup_.run(kernel, world) : device_.run(world, setup_.mode, setup_.watch);
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
  Host host(std::move(setup), program.form);
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
