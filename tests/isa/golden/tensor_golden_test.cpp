// Multiplies matrices that an H200 has multiplied, from PTX text on all SIMD paths, and expects the same
// bits.
// SPDX-License-Identifier: Apache-2.0
//
// GLINT_TENSOR_GOLDEN_DIR names the folder of another recording by tools/record_tensor_vectors.py.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "frontend/ptx/ptx.h"
#include "isa/paths.h"
#include "pipeline/functional_machine.h"
#include "pipeline/kernel_launch.h"
#include "tests/isa/golden/recording.h"
#include "tests/support/catch.h"

using namespace glint;

namespace {

// Holds one opcode. A sample has the words of A, B, C and D, each by registers and then by lanes.
struct TensorForm {
  std::string op;
  uint32_t bits = 32, samples = 0;
  uint32_t registers[4] = {};
  size_t offset = 0;  // of the first sample
  size_t bytes(int matrix) const { return size_t{registers[matrix]} * bits / 8 * 32; }
  size_t sample_bytes() const { return bytes(0) + bytes(1) + bytes(2) + bytes(3); }
};

std::vector<TensorForm> read_forms(const std::string& text) {
  std::vector<TensorForm> out;
  std::istringstream lines(text);
  size_t offset = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("//")) continue;
    TensorForm form;
    std::istringstream words(line);
    words >> form.op >> form.bits;
    for (uint32_t& n : form.registers) words >> n;
    words >> form.samples;
    form.offset = offset;
    offset += form.sample_bytes() * form.samples;
    out.push_back(form);
  }
  return out;
}

// Returns a kernel in which each block of one warp multiplies one sample.
std::string tensor_kernel(const TensorForm& form) {
  const char names[] = "abcd";
  std::string text =
      ".version 8.0\n.target sm_90\n.address_size 64\n.visible .entry k(.param .u64 pd, .param .u64 pa, "
      ".param "
      ".u64 pb, .param .u64 pc)\n{\n.reg .b32 %lane, %block; .reg .b64 %at, %off;\n";
  std::string groups[4];
  for (int i = 0; i < 4; ++i) {
    text += fmt::format(".reg .{}{} %{}<{}>;\n", form.bits == 64 ? "f" : "b", form.bits, names[i],
                        form.registers[i]);
    for (uint32_t r = 0; r < form.registers[i]; ++r)
      groups[i] += fmt::format("{}%{}{}", r ? "," : "", names[i], r);
  }
  text += "mov.u32 %lane, %tid.x; mov.u32 %block, %ctaid.x;\n";
  const auto place = [&](int i) {
    text += fmt::format(
        "ld.param.u64 %at, [p{}]; mul.wide.u32 %off, %block, {}; add.u64 %at, %at, %off; mul.wide.u32 %off, "
        "%lane, {}; "
        "add.u64 %at, %at, %off;\n",
        names[i], form.bytes(i), form.bits / 8);
  };
  const uint32_t row = form.bits * 4;
  for (int i = 0; i < 3; ++i) {
    place(i);
    for (uint32_t r = 0; r < form.registers[i]; ++r)
      text += fmt::format("ld.global.b{} %{}{}, [%at+{}];\n", form.bits, names[i], r, r * row);
  }
  text += fmt::format("{} {{{}}}, {{{}}}, {{{}}}, {{{}}};\n", form.op, groups[3], groups[0], groups[1],
                      groups[2]);
  place(3);
  for (uint32_t r = 0; r < form.registers[3]; ++r)
    text += fmt::format("st.global.b{} [%at+{}], %d{};\n", form.bits, r * row, r);
  return text + "ret;\n}\n";
}

// Returns the bytes of one matrix of all samples, one behind the other.
std::vector<std::byte> matrices(const TensorForm& form, const std::string& data, int matrix) {
  std::vector<std::byte> out(form.bytes(matrix) * form.samples);
  size_t before = 0;
  for (int i = 0; i < matrix; ++i) before += form.bytes(i);
  for (uint32_t s = 0; s < form.samples; ++s)
    std::memcpy(&out[s * form.bytes(matrix)], &data[form.offset + s * form.sample_bytes() + before],
                form.bytes(matrix));
  return out;
}

std::vector<std::byte> results_of(const frontend::Kernel& kernel, const TensorForm& form,
                                  const std::string& data, isa::Path path) {
  pipeline::KernelWorld world(kernel);
  golden::use_path(world, path);
  std::vector<std::vector<std::byte>> arguments;
  const auto add = [&](const std::vector<std::byte>& bytes) {
    const Address at = world.memory().allocate("argument", bytes.size());
    world.memory().write(at, bytes.data(), bytes.size());
    arguments.push_back(pipeline::KernelWorld::argument(at));
    return at;
  };
  const size_t size = form.bytes(3) * form.samples;
  const Address results = add(std::vector<std::byte>(size));
  for (int matrix = 0; matrix < 3; ++matrix) add(matrices(form, data, matrix));
  world.set_grid({{form.samples, 1, 1}, {32, 1, 1}, 0});
  world.set_arguments(arguments);
  pipeline::run_functional(world.world, 1'000'000'000, {});
  const auto view = world.memory().view<std::byte>(results, size);
  return {view.begin(), view.end()};
}

size_t num_different(const std::vector<std::byte>& a, const std::vector<std::byte>& b) {
  size_t out = 0;
  for (size_t i = 0; i < a.size(); ++i) out += a[i] != b[i];
  return out;
}

}  // namespace

TEST_CASE("products of matrices have the bits of an H200") {
  const char* const other = std::getenv("GLINT_TENSOR_GOLDEN_DIR");
  const std::filesystem::path folder =
      other ? std::filesystem::path(other)
            : std::filesystem::path(GLINT_SOURCE_DIR) / "tests/isa/golden/tensor";
  const std::string data = golden::contents(folder / "words.bin");
  const std::vector<TensorForm> forms = read_forms(golden::contents(folder / "forms.txt"));
  REQUIRE(forms.size() > 40);
  for (const TensorForm& form : forms) {
    INFO(form.op);
    const frontend::Kernel kernel = frontend::compile_ptx(tensor_kernel(form), "test.ptx", "k", {});
    const std::vector<std::byte> wanted = matrices(form, data, 3);
    for (int p = 0; p < int(isa::Path::Count); ++p)
      if (isa::is_supported(isa::Path(p))) {
        INFO(isa::name_of(isa::Path(p)));
        CHECK(num_different(results_of(kernel, form, data, isa::Path(p)), wanted) == 0);
      }
  }
}
