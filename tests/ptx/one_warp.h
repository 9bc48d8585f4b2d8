// Runs kernels of one warp that tests write down in a line or two, and checks that shaping changes no result.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "isa/text.h"
#include "tests/ptx/launcher.h"
#include "tests/support/catch.h"

namespace glint {

inline const std::string kHead = ".version 7.0\n.target sm_70\n.address_size 64\n";

// Returns a kernel `k` of one warp that stores the word %out of each thread to the buffer of its parameter.
inline std::string storing(const std::string& body, const std::string& before = "") {
  return kHead + before +
         ".visible .entry k(.param .u64 to)\n{\n.reg .b32 %out, %lane, %r<40>; .reg .b64 %at, %rd<20>; .reg "
         ".pred %p<20>; .reg .f32 %f<9>;\n"
         "mov.u32 %lane, %tid.x; mov.u32 %out, 0;\n" +
         body +
         "\nld.param.u64 %at, [to]; mad.wide.u32 %at, %lane, 4, %at; st.global.u32 [%at], %out; ret;\n}\n";
}

inline std::vector<uint32_t> outputs(const std::string& text,
                                     const pipeline::KernelGrid& grid = {{1, 1, 1}, {32, 1, 1}, 0},
                                     const frontend::PtxOptions& options = {}) {
  Launcher k(text, "test.ptx", "k", options);
  const uint32_t threads = grid.block[0] * grid.block[1] * grid.block[2];
  k.buffer(std::vector<uint32_t>(threads));
  k.run_functional(grid);
  return k.read<uint32_t>(0, threads);
}

inline const pipeline::KernelGrid kWarp{{1, 1, 1}, {32, 1, 1}, 0};

// Returns the kernel as it runs after shaping. Its results are checked against those of the unshaped text.
inline std::string shaped(const std::string& body, const std::string& before = "") {
  const std::string text = storing(body, before);
  frontend::PtxOptions plain;
  plain.shape = false;
  CHECK(outputs(text) == outputs(text, kWarp, plain));
  return isa::to_text(frontend::compile_ptx(text, "test.ptx", "k", {}).program);
}
inline size_t count(const std::string& text, const std::string& part) {
  size_t n = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

// Returns the words that `of_lane` gives for the lanes of a warp.
inline std::vector<uint32_t> expected(uint32_t (*of_lane)(uint32_t)) {
  std::vector<uint32_t> out;
  for (uint32_t lane = 0; lane < 32; ++lane) out.push_back(of_lane(lane));
  return out;
}

// Returns what the compiler says against a text, or "no error".
inline std::string message_of(const std::string& text) {
  try {
    frontend::compile_ptx(text, "test.ptx", "", {});
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace glint
