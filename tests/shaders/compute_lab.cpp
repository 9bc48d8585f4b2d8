// Builds the world of a compute shader: memory, descriptors, images, blocks.
// SPDX-License-Identifier: Apache-2.0
#include "tests/shaders/compute_lab.h"

#include <cstring>
#include <fmt/format.h>

#include "pipeline/functional_machine.h"
#include "pipeline/timing_machine.h"

namespace glint::test {
namespace {

constexpr uint64_t kBudget = 2'000'000;  // instructions per warp

struct Bench {
  exec::World world;
  mem::AddressSpace memory;

  void bind(uint32_t binding, uint64_t address_or_number, uint64_t bytes_or_count) {
    const uint64_t descriptor[2] = {address_or_number, bytes_or_count};
    std::memcpy(world.constant_bank.data() + binding * isa::kDescriptorBytes, descriptor, sizeof(descriptor));
  }
  Address place(const std::string& name, const Words& words) {
    const Address at = memory.allocate(name, words.size() * 4);
    memory.write(at, words.data(), words.size() * 4);
    return at;
  }
  void take(Address at, Words& words) {
    const auto now = memory.view<uint32_t>(at, words.size());
    words.assign(now.begin(), now.end());
  }
};

}  // namespace

void ComputeLab::run(const LabOptions& options) {
  Bench bench;
  exec::World& world = bench.world;
  const std::vector<isa::Program> programs{compile_lab(file_, glsl, options)};
  const exec::Image code = exec::link(programs);
  world.image = &code;
  world.memory = &bench.memory;
  world.constant_bank.resize(isa::kConstantBankBytes);
  world.raygen = 0;
  world.local_bytes = (programs[0].local_bytes + 15) / 16 * 16;
  exec::set_blocks(world, grid, programs[0].local_size, programs[0].shared_bytes);
  exec::place_plain_table(world, bench.memory.allocate("binding table", exec::plain_table_bytes(world)));

  std::map<uint32_t, Address> address;
  for (const auto& [binding, words] : buffers) {
    address[binding] = bench.place(fmt::format("binding {}", binding), words);
    bench.bind(binding, address[binding], words.size() * 4);
  }
  for (uint32_t i = 0; i + 1 < linked.count; ++i) {
    const Address next = address.at(linked.binding) + Address(i + 1) * linked.bytes;
    bench.memory.write(address.at(linked.binding) + Address(i) * linked.bytes, &next, 8);
  }
  std::map<uint32_t, std::vector<uint64_t>> tables;
  for (const auto& [binding, all] : buffer_arrays) {
    for (const Words& words : all)
      tables[binding].insert(tables[binding].end(), {bench.place("element", words), words.size() * 4});
    Words table(tables[binding].size() * 2);
    std::memcpy(table.data(), tables[binding].data(), table.size() * 4);
    bench.bind(binding, bench.place(fmt::format("table {}", binding), table), all.size());
  }
  for (auto& [binding, all] : images) {
    bench.bind(binding, world.images.size(), all.size());
    for (LabImage& image : all) {
      image.view.base = bench.place(fmt::format("image {}", binding), image.texels);
      image.view.name = fmt::format("image {}", binding);
      world.images.push_back(image.view);
    }
  }
  for (const auto& [binding, all] : samplers) {
    bench.bind(binding, world.samplers.size(), all.size());
    world.samplers.insert(world.samplers.end(), all.begin(), all.end());
  }
  for (size_t i = 0; i < addressed.size(); ++i)
    std::memcpy(world.constant_bank.data() + isa::kPushConstantOffset + 8 * i, &address.at(addressed[i]), 8);

  world.on_fault = options.on_fault;
  if (options.timing) {
    pipeline::GpuParams gpu;
    gpu.cores = 2;
    gpu.core.instruction_budget = kBudget;
    pipeline::TimingMachine machine(gpu, world, false);
    machine.run({});
    faults = machine.passed();
  } else {
    faults = pipeline::run_functional(world, kBudget, {}).faults;
  }
  for (auto& [binding, words] : buffers) bench.take(address[binding], words);
  for (auto& [binding, all] : buffer_arrays)
    for (size_t i = 0; i < all.size(); ++i) bench.take(tables[binding][2 * i], all[i]);
  for (auto& [binding, all] : images)
    for (LabImage& image : all) bench.take(image.view.base, image.texels);
}

const std::vector<LabOptions>& compute_lab_options() {
  static const std::vector<LabOptions> kSome = {
      {24, true, false}, {64, true, false}, {64, false, false}, {64, true, true}};
  return kSome;
}

}  // namespace glint::test
