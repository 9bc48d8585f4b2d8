// Lists the programs of the compute suite: classic GPU computations with inputs, launches and a reference.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace glint::compute {

class Host;

// Full is the input that the literature uses; Small ends within seconds on the timing machine.
enum class Size : uint8_t { Small, Full };

// The language of a program's kernels. The suite is in GLSL.
enum class Form : uint8_t { Glsl, Ptx };

struct Program {
  std::string name, doc;
  std::string_view small_input, full_input;  // in words, such as "512 x 512 cells, 2 steps"
  double small_seconds, full_seconds;        // on the timing machine; a plan needs only their ratios
  double full_megabytes;                     // of the host, beyond those of a small program
  // Makes the input, launches the kernels and checks every value that they leave behind.
  void (*run)(Host& host, Size size);
  bool has_ptx = false;  // NAME-ptx is the same with kernels in PTX.
  Form form = Form::Glsl;
};

// Returns all programs in all their forms, by name.
std::span<const Program> all_programs();
// Returns the program of that name, or null.
const Program* find_program(std::string_view name);

}  // namespace glint::compute
