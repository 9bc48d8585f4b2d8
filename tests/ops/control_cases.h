// Lists programs whose results show what the control ops, barriers, fences and prints do to a warp.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glint::test {

inline constexpr size_t kControlWords = 2;  // words that each thread leaves
using ControlWords = std::array<uint32_t, kControlWords>;

// Holds one program of one block. It leaves the words %r20 and %r21 of each thread, unless it has ended
// before. %r4 is the number of the thread, %p1 and up and %r5 and up are free.
struct ControlCase {
  std::string_view op;  // the op that the case shows
  uint32_t threads = 32;
  std::string text;
  ControlWords (*expected)(uint32_t thread) = nullptr;
  std::string fault = {};                // part of the message of the fault that ends the run
  std::string printed = {};              // what the program prints
  std::string functions = {};            // code behind the program
  std::string header = {};               // directives before it
  std::vector<std::string> called = {};  // programs that call.function calls
};
const std::vector<ControlCase>& control_cases();
// Returns those of them that copy to shared memory or use barriers there.
std::vector<ControlCase> async_cases();

}  // namespace glint::test
