// Reads launches of PTX kernels from a TOML file: grids, arguments, what to keep.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "pipeline/description/description.h"
#include "pipeline/kernel_launch.h"

namespace glint::app {

struct LaunchArgument {
  std::vector<std::byte> bytes;  // bytes of the number, or what the buffer holds at first
  bool is_buffer = false;
  bool is_known = false;   // The buffer is that of an earlier argument with this name.
  std::string name, type;  // used for a buffer
  bool save = false;       // writes the buffer to NAME.bin in the run directory
  uint32_t show = 0;       // how many of the first values are printed
  SourceLocation where;
};

struct KernelLaunch {
  std::string name;      // empty: the file has one launch
  std::string kernel;    // path of the PTX file
  std::string entry;     // empty: the only entry
  bool contract = true;  // frontend::PtxOptions::contract
  bool warm = false;     // It begins with what the launch before it left in the caches.
  uint64_t heap_bytes = frontend::kDefaultHeapBytes;  // frontend::PtxOptions::heap_bytes
  pipeline::KernelGrid grid;
  std::vector<LaunchArgument> arguments;
  SourceLocation where, kernel_where;  // of the launch, and of the key that names its kernel
};

struct LaunchFile {
  std::vector<KernelLaunch> launches;         // in order, at least one
  std::vector<pipeline::KernelImage> images;  // Arguments have their numbers as handles.
  bool is_list() const { return !launches[0].name.empty(); }
};

// Reads a launch file; shaders/kernels/README.md describes the format. Throws UserError that lists every
// mistake with file, line and column.
LaunchFile read_launch(const std::string& path);

// Returns the first values of an array of that type as text: "0.5 1 1.5 ...".
std::string first_values(const std::string& type, const std::byte* data, size_t bytes, uint32_t count);

}  // namespace glint::app
