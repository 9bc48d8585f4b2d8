// Places a kernel and its module's variables.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/kernel_launch.h"

#include <fmt/format.h>
#include <map>
#include <utility>

#include "base/diagnostics.h"
#include "exec/block.h"
#include "isa/generic_address.h"
#include "pipeline/launch_size.h"

namespace glint::pipeline {

frontend::PtxOptions ptx_options(const CompilerParams& compiler, bool contract) {
  frontend::PtxOptions out;
  out.backend.max_registers = compiler.max_registers;
  out.backend.schedule = compiler.schedule;
  out.backend.guard_latency = compiler.guard_latency;
  out.contract = contract;
  return out;
}

KernelWorld::KernelWorld(frontend::Kernel kernel, std::shared_ptr<mem::AddressSpace> memory,
                         ModuleVariables* variables)
    : kernel_(std::move(kernel)), memory_(std::move(memory)) {
  std::vector<isa::Program> programs{kernel_.program};
  programs.insert(programs.end(), kernel_.functions.begin(), kernel_.functions.end());
  image = exec::link(programs);
  world.image = &image;
  world.memory = memory_.get();
  world.raygen = 0;
  world.constant_bank.resize(kernel_.constant_bank_bytes);
  ModuleVariables own;
  place_variables(variables ? *variables : own);
}

// Variables that another kernel of the module has placed keep what they hold.
void KernelWorld::place_variables(ModuleVariables& placed) {
  std::map<std::string, uint64_t> address;  // generic addresses, as pointers in memory hold them
  std::map<std::string, std::byte*> data;   // of the variables that are new
  for (const frontend::ModuleVariable& v : kernel_.variables) {
    if (v.is_constant) {
      address[v.name] = isa::window_of(isa::Space::Const) + v.offset;
      data[v.name] = world.constant_bank.data() + v.offset;
    } else {
      const auto [known, is_new] = placed.try_emplace(v.name);
      if (is_new) known->second = memory_->allocate(v.name, std::max<uint64_t>(v.bytes, 1));
      const Address at = address[v.name] = known->second;
      std::memcpy(world.constant_bank.data() + v.offset, &at, sizeof at);
      if (!is_new) continue;
      data[v.name] = memory_->find(at, v.bytes);
    }
    if (!v.initial.empty()) std::memcpy(data[v.name], v.initial.data(), v.initial.size());
  }
  for (const frontend::ModuleVariable& v : kernel_.variables) {
    if (!data.contains(v.name)) continue;
    for (const frontend::ModuleVariable::Pointer& pointer : v.pointers) {
      const auto target = address.find(pointer.symbol);
      if (target == address.end())
        throw UnsupportedError(
            fmt::format("variable '{}' holds the address of '{}', which is not a variable of the module in "
                        "global or constant memory",
                        v.name, pointer.symbol));
      const uint64_t value = target->second + pointer.addend;
      std::memcpy(data[v.name] + pointer.at, &value, sizeof value);
    }
  }
}

void KernelWorld::set_grid(const KernelGrid& grid) {
  const std::string& name = kernel_.program.name;
  const auto size = [](const std::array<uint32_t, 3>& s) {
    return fmt::format("{} x {} x {}", s[0], s[1], s[2]);
  };
  for (const auto& s : {grid.grid, grid.block})
    for (uint32_t axis : s)
      if (axis == 0)
        throw UserError({}, fmt::format("kernel '{}': a grid of {} blocks of {} threads is empty", name,
                                        size(grid.grid), size(grid.block)));
  const uint64_t threads = uint64_t{grid.block[0]} * grid.block[1] * grid.block[2];
  if (threads > exec::kMaxBlockThreads)
    throw UserError({}, fmt::format("kernel '{}' has {} threads per block, and at most {} are possible", name,
                                    threads, exec::kMaxBlockThreads));
  if (kernel_.required_block && *kernel_.required_block != grid.block)
    throw UserError({}, fmt::format("kernel '{}' asks for blocks of {} threads (.reqntid), not {}", name,
                                    size(*kernel_.required_block), size(grid.block)));
  if (kernel_.largest_block) {
    const auto& most = *kernel_.largest_block;
    if (threads > uint64_t{most[0]} * most[1] * most[2])
      throw UserError({}, fmt::format("kernel '{}' takes blocks of at most {} threads (.maxntid), not {}",
                                      name, size(most), size(grid.block)));
  }
  check_launch_size(grid.grid, grid.block, SourceLocation{name});
  exec::set_blocks(world, grid.grid, grid.block, kernel_.program.shared_bytes, grid.dynamic_shared_bytes);
  world.in_clusters = kernel_.in_clusters;
  set_stack(grid.stack_bytes);
}

void KernelWorld::set_stack(std::optional<uint32_t> bytes) {
  if (bytes && *bytes > kMostStackBytes)
    throw UserError(
        {}, fmt::format("kernel '{}': a stack of {} bytes is larger than the {} that a thread may have",
                        kernel_.program.name, *bytes, kMostStackBytes));
  constexpr uint32_t kAlignment = 16;
  const uint32_t calls = kernel_.functions.empty() ? 0 : bytes.value_or(kDefaultStackBytes);
  world.local_bytes = kernel_.program.local_bytes + calls / kAlignment * kAlignment;
}

void KernelWorld::set_arguments(const std::vector<std::vector<std::byte>>& arguments) {
  const std::string& name = kernel_.program.name;
  if (arguments.size() != kernel_.parameters.size())
    throw UserError({}, fmt::format("kernel '{}' has {} parameters, but {} arguments are given", name,
                                    kernel_.parameters.size(), arguments.size()));
  for (size_t i = 0; i < arguments.size(); ++i) {
    const frontend::KernelParameter& p = kernel_.parameters[i];
    if (arguments[i].size() != p.bytes)
      throw UserError(
          {}, fmt::format("kernel '{}': parameter {} ('{}') has {} bytes, and its argument has {}", name, i,
                          p.name, p.bytes, arguments[i].size()));
    std::memcpy(world.constant_bank.data() + isa::kPushConstantOffset + p.offset, arguments[i].data(),
                p.bytes);
  }
}

}  // namespace glint::pipeline
