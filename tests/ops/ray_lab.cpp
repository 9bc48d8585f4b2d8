// Links the shaders of a pipeline, fills its binding table, and runs it.
// SPDX-License-Identifier: Apache-2.0
#include "tests/ops/ray_lab.h"

#include <cstring>
#include <fmt/format.h>
#include <utility>

#include "base/diagnostics.h"
#include "isa/text.h"
#include "isa/verify.h"
#include "tests/ops/machine_run.h"
#include "tests/ops/op_lab.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

isa::Program program_of(const LabShader& shader, size_t number) {
  const std::string name = fmt::format("shader {} ({})", number, shader.stage);
  isa::Program program =
      isa::parse(fmt::format(".program \"{}\"\n.stage {}\n.registers 128\n\n", name, shader.stage) +
                     own_words() + shader.body,
                 name);
  program.local_bytes = RayLab::kFrameBytes;
  Diagnostics diagnostics;
  isa::verify(program, diagnostics);
  diagnostics.throw_if_errors();
  return program;
}

}  // namespace

uint32_t record_word(Region region, uint32_t record) {
  return 0x5a00'0000u + uint32_t(region) * 0x10'0000u + record * 3;
}

std::string own_words() {
  return fmt::format(
      "    ld.const.b64 %rd2, [{0}];\n    mad.wide.u32 %rd2, %launch.x, {2}, %rd2;\n"
      "    ld.const.b64 %rd4, [{1}];\n    mad.wide.u32 %rd4, %launch.x, {3}, %rd4;\n",
      isa::kPushConstantOffset, isa::kPushConstantOffset + 8, RayLab::kInputWords * 4, RayLab::kLogWords * 4);
}

std::string log_word(uint32_t at, std::string_view value) {
  return fmt::format("    st.global.b32 [%rd4 + {}], {};\n", 4 * at, value);
}

std::string log_predicate(uint32_t at, std::string_view predicate) {
  return fmt::format("    selp.b32 %r9, 1, 0, {};\n", predicate) + log_word(at, "%r9");
}

RayLab::RayLab(const std::vector<LabShader>& shaders) {
  std::vector<isa::Program> programs;
  for (const LabShader& shader : shaders) programs.push_back(program_of(shader, programs.size()));
  image_ = exec::link(programs);
  inputs_ = memory.allocate("inputs", kThreads * kInputWords * 4);
  log_ = memory.allocate("log", kThreads * kLogWords * 4);
  world.image = &image_;
  world.memory = &memory;
  world.raygen = 0;
  world.launch_size = {uint32_t(kThreads), 1, 1};
  world.local_bytes = 4 * kFrameBytes;
  world.max_trace_depth = 2;
  world.constant_bank.resize(isa::kConstantBankBytes);
  const Address parameters[] = {inputs_, log_};
  std::memcpy(world.constant_bank.data() + isa::kPushConstantOffset, parameters, sizeof parameters);
}

void RayLab::place_table() {
  const auto place = [&](std::string name, Region region, size_t records) {
    const Address base = memory.allocate(std::move(name), (records + 1) * kRecordStride);
    for (uint32_t i = 0; i < records; ++i) {
      const uint32_t word = record_word(region, i);
      memory.write(base + Address(i) * kRecordStride + exec::kHandleBytes, &word, sizeof word);
    }
    return base;
  };
  world.table.raygen = place("ray generation record", Region::RayGeneration, 1);
  world.table.miss = {place("miss records", Region::Miss, world.miss.size()), kRecordStride};
  world.table.hit = {place("hit records", Region::Hit, world.hit.size()), kRecordStride};
  world.table.callable = {place("callable records", Region::Callable, world.callable.size()), kRecordStride};
}

RayLab::Outcome RayLab::run_on(Machine which, const isa::OpRow& counted, const ThreadWords& inputs) {
  REQUIRE(inputs.size() == kThreads);
  for (size_t t = 0; t < kThreads; ++t) {
    REQUIRE(inputs[t].size() <= kInputWords);
    memory.write(inputs_ + t * kInputWords * 4, inputs[t].data(), inputs[t].size() * 4);
  }
  const std::vector<uint32_t> unwritten(kThreads * kLogWords, kUnwritten);
  memory.write(log_, unwritten.data(), unwritten.size() * 4);
  Outcome out;
  run_machine(world, which, 1'000'000, counted, out.lanes);
  const auto words = memory.view<uint32_t>(log_, kThreads * kLogWords);
  for (size_t t = 0; t < kThreads; ++t)
    out.log.emplace_back(words.begin() + ptrdiff_t(t * kLogWords),
                         words.begin() + ptrdiff_t((t + 1) * kLogWords));
  return out;
}

RayLab::Outcome RayLab::run(const isa::OpRow& counted, const ThreadWords& inputs) {
  Outcome functional = run_on(Machine::Functional, counted, inputs);
  for (const Machine which : {Machine::TwoCores, Machine::Sorting}) {
    const Outcome timing = run_on(which, counted, inputs);
    CHECK(functional.log == timing.log);
    CHECK(functional.lanes == timing.lanes);
  }
  return functional;
}

}  // namespace glint::test
