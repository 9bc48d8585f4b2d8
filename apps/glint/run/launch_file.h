// A launch of a PTX kernel as a TOML file describes it: grid, arguments, what to keep.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "pipeline/kernel_launch.h"

namespace glint::app {

struct LaunchArgument {
  std::vector<std::byte> bytes;  // of the number, or what the buffer holds at first
  bool is_buffer = false;
  std::string name, type;  // of a buffer
  bool save = false;       // to NAME.bin of the run directory
  uint32_t show = 0;       // first values to print
  SourceLocation where;
};

struct LaunchFile {
  std::string kernel;    // path of the PTX file
  std::string entry;     // empty: the only one
  bool contract = true;  // frontend::PtxOptions::contract
  pipeline::KernelGrid grid;
  std::vector<LaunchArgument> arguments;
};

// Format: shaders/kernels/README.md. UserError lists every mistake with file, line and column.
LaunchFile read_launch(const std::string& path);

// "0.5 1 1.5 ...": the first values of an array of that type.
std::string first_values(const std::string& type, const std::byte* data, size_t bytes, uint32_t count);

}  // namespace glint::app
