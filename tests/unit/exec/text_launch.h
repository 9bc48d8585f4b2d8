// Runs a program written as text on a grid of blocks, and holds a buffer of words that it fills.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "exec/image.h"
#include "isa/text.h"
#include "isa/verify.h"
#include "pipeline/functional_machine.h"

namespace glint::exec {

// Launches a program, which finds the buffer's address at parameter 0.
struct TextLaunch {
  struct Options {
    std::array<uint32_t, 3> grid{1, 1, 1}, block{32, 1, 1};
    uint32_t shared_bytes = 0, dynamic_bytes = 0, local_bytes = 0;
    uint32_t buffer_words = 1024;
    std::vector<std::string> functions = {};  // programs that call.function calls, each with its directives
    uint32_t stack_bytes = 0;                 // that they have, behind `local_bytes`
  };

  TextLaunch(const std::string& body, Options options, isa::Stage stage = isa::Stage::Compute) {
    std::vector<isa::Program> programs;
    programs.push_back(isa::parse(".program \"test\"\n.stage compute\n.registers 64\n\n" + body, "test"));
    programs.back().stage = stage;
    programs.back().shared_bytes = options.shared_bytes + options.dynamic_bytes;
    programs.back().local_bytes = options.local_bytes;
    for (const std::string& function : options.functions)
      programs.push_back(
          isa::parse(".program \"function\"\n.stage compute\n.registers 64\n\n" + function, "test"));
    Diagnostics diagnostics;
    for (const isa::Program& program : programs) isa::verify(program, diagnostics);
    diagnostics.throw_if_errors();
    image = link(programs);
    world.image = &image;
    world.memory = &memory;
    world.raygen = 0;
    world.constant_bank.resize(isa::kConstantBankBytes);
    world.local_bytes = options.local_bytes + options.stack_bytes;
    set_blocks(world, options.grid, options.block, options.shared_bytes, options.dynamic_bytes);
    num_words = options.buffer_words;
    buffer = memory.allocate("buffer", num_words * 4ull);
    std::memcpy(world.constant_bank.data() + isa::kPushConstantOffset, &buffer, sizeof buffer);
  }

  TextLaunch& run() {
    pipeline::run_functional(world, 1'000'000, {});
    return *this;
  }
  // Returns what run() says of a fault, or "" when it ends well.
  std::string fault() {
    try {
      run();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  uint32_t& word(uint32_t index) { return memory.view<uint32_t>(buffer, num_words)[index]; }
  std::vector<uint32_t> words(uint32_t first, uint32_t count) {
    const auto all = memory.view<uint32_t>(buffer, num_words);
    return {all.begin() + first, all.begin() + first + count};
  }

  mem::AddressSpace memory;
  World world;
  Image image;
  Address buffer = 0;
  uint32_t num_words = 0;
};

// Sets %rd2 to the address of word %tid.x of the buffer, and %r4 to %tid.x.
inline const std::string kOwnWord =
    "    ld.param.b64 %rd2, [0];\n"
    "    mov.b32 %r4, %tid.x;\n"
    "    mad.wide.u32 %rd2, %r4, 4, %rd2;\n";

}  // namespace glint::exec
