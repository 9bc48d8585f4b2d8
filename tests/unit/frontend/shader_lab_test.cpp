// Implements the shader lab and tests that it detects a wrong result.
// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/frontend/shader_lab.h"

#include <bit>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <unistd.h>

#include "exec/executor.h"
#include "exec/image.h"
#include "isa/verify.h"
#include "memsys/address_space.h"
#include "tests/support/catch.h"

namespace glint::frontend::lab {

namespace fs = std::filesystem;

Folder::Folder() {
  static int number = 0;
  path_ = fs::temp_directory_path() / fmt::format("glint_frontend_{}_{}", getpid(), number++);
  fs::create_directories(path_);
}
Folder::~Folder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}
std::string Folder::write(const std::string& name, const std::string& text) const {
  const fs::path file = path_ / name;
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
  return file.string();
}

std::string source(const std::string& body) {
  return "#version 460\n#extension GL_EXT_ray_tracing : require\n#extension GL_EXT_nonuniform_qualifier : "
         "require\n"
         "#extension GL_EXT_scalar_block_layout : require\n" +
         body;
}

std::vector<uint32_t> simplified(const std::string& ending, const std::string& body) {
  const Folder folder;
  const std::string path = folder.write("shader" + ending, source(body));
  Diagnostics warnings;
  return simplify(glsl_to_spirv(path, {}), path, warnings);
}

VirtualProgram lowered(const std::string& ending, const std::string& body) {
  return lower_to_virtual(simplified(ending, body), "shader" + ending);
}

int count(const VirtualProgram& program, std::string_view op) {
  int n = 0;
  for (const VirtualBlock& block : program.blocks)
    for (const VirtualInst& inst : block.code)
      n += inst.kind == VirtualInst::Kind::Real && isa::op_table()[inst.op].name == op;
  return n;
}

int count_markers(const VirtualProgram& program, VirtualInst::Kind kind) {
  int n = 0;
  for (const VirtualBlock& block : program.blocks)
    for (const VirtualInst& inst : block.code) n += inst.kind == kind;
  return n;
}

namespace {

void put_descriptor(exec::World& world, uint32_t binding, uint64_t address, uint64_t bytes) {
  std::memcpy(world.constant_bank.data() + binding * isa::kDescriptorBytes, &address, 8);
  std::memcpy(world.constant_bank.data() + binding * isa::kDescriptorBytes + 8, &bytes, 8);
}

}  // namespace

std::vector<uint32_t> run(const std::vector<uint32_t>& inputs, const std::string& statements,
                          const std::string& globals, const BackendOptions& options) {
  const std::string body =
      "layout(local_size_x = 32) in;\n"
      "layout(binding = 0) readonly buffer In { uint values[]; } inputs;\n"
      "layout(binding = 1) buffer Out { uint values[]; } outputs;\n" +
      globals + "\nvoid main() {\n  uint i = gl_GlobalInvocationID.x;\n  uint x = inputs.values[i];\n" +
      "  float f = uintBitsToFloat(x);\n  uint y = 0;\n" + statements + "\n  outputs.values[i] = y;\n}\n";
  const isa::Program program = lower(simplified(".comp", body), "shader.comp", options);
  Diagnostics diagnostics;
  isa::verify(program, diagnostics);
  diagnostics.throw_if_errors();

  const exec::Image image = exec::link({program});
  mem::AddressSpace memory;
  exec::World world;
  world.image = &image;
  world.memory = &memory;
  world.constant_bank.resize(isa::kConstantBankBytes);
  world.raygen = 0;
  world.launch_size = {uint32_t(inputs.size()), 1, 1};
  world.local_bytes = program.local_bytes;
  const uint64_t bytes = inputs.size() * 4;
  const Address in = memory.allocate("in", bytes), out = memory.allocate("out", bytes);
  memory.write(in, inputs.data(), bytes);
  put_descriptor(world, 0, in, bytes);
  put_descriptor(world, 1, out, bytes);

  exec::Executor executor(world);
  exec::WarpContext warp;
  for (uint32_t w = 0; w < executor.num_warps(); ++w) {
    executor.start(warp, w);
    for (uint64_t n = 0; !executor.execute(warp, 0).finished; ++n) {
      if (executor.fault()) throw Error(Exit::Fault, executor.fault()->to_string());
      if (n > 1'000'000) throw Error(Exit::Fault, "the shader does not end");
    }
    if (executor.fault()) throw Error(Exit::Fault, executor.fault()->to_string());
  }
  std::vector<uint32_t> result(inputs.size());
  std::memcpy(result.data(), memory.find(out, bytes), bytes);
  return result;
}

std::vector<float> run_f32(const std::vector<float>& inputs, const std::string& expression_of_f,
                           const std::string& globals) {
  std::vector<uint32_t> bits;
  for (float f : inputs) bits.push_back(std::bit_cast<uint32_t>(f));
  std::vector<float> result;
  for (uint32_t y : run(bits, "  y = floatBitsToUint(" + expression_of_f + ");", globals))
    result.push_back(std::bit_cast<float>(y));
  return result;
}

TEST_CASE("the shader lab runs each lane on its own input") {
  std::vector<uint32_t> inputs, expected;
  for (uint32_t i = 0; i < 77; ++i) inputs.push_back(i * 1000), expected.push_back(i * 1000 + i);
  CHECK(run(inputs, "y = x + i;") == expected);
}

}  // namespace glint::frontend::lab
