// Compiles one kernel of PTX text to an isa::Program, with what a launch must know: parameters, variables,
// shared memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "frontend/compile.h"
#include "isa/program.h"

namespace glint::frontend {

// Describes a parameter of a kernel, in PTX's layout. `offset` counts from isa::kPushConstantOffset of the
// constant bank.
struct KernelParameter {
  std::string name;
  uint32_t offset = 0, bytes = 0;
  std::string type;  // type of its elements as PTX writes it, such as "u64"
};

// Describes a variable of the module, which the launch must place and fill.
struct ModuleVariable {
  // Says that the address of `symbol` plus `addend`, 8 bytes, is stored at `at`.
  struct Pointer {
    uint64_t at = 0;
    std::string symbol;
    uint64_t addend = 0;
  };
  std::string name;
  // With true, the variable lies in the constant bank at `offset`. With false, it lies in global memory.
  bool is_constant = false;
  uint32_t offset = 0;  // global: place in the constant bank of its 8-byte address
  uint64_t bytes = 0;
  std::vector<std::byte> initial;  // the bytes after its end are 0
  std::vector<Pointer> pointers;
};

struct Kernel {
  isa::Program program;                 // shared_bytes: the static part
  std::vector<isa::Program> functions;  // that it calls, because they cannot be a part of it
  std::vector<KernelParameter> parameters;
  std::vector<ModuleVariable> variables;
  uint32_t constant_bank_bytes = isa::kConstantBankBytes;                // the minimum that the kernel needs
  std::optional<std::array<uint32_t, 3>> required_block, largest_block;  // .reqntid, .maxntid
  // Each block is a cluster: .reqnctapercluster 1, which nvcc writes for __block_size__ and
  // __cluster_dims__(1).
  bool in_clusters = false;
};

inline constexpr uint64_t kDefaultHeapBytes = 8 << 20;
// The heap begins with the number of bytes that are in use.
inline constexpr uint64_t kHeapHeader = 16;

struct PtxOptions {
  BackendOptions backend;
  // Makes a mul followed by an add or sub, all without a rounding modifier, one fma where nothing else reads
  // the product. Choice: PTX allows it ("may be optimized aggressively"), and NVIDIA's assembler does it
  // unless -fmad=false is given.
  bool contract = true;
  // Changes the program as the hardware's assembler does (frontend/ptx/machine.h), which gives fewer
  // instructions and the same results.
  bool shape = true;
  // Bytes that kernels can take with malloc and new. Choice: the default is CUDA's (cudaLimitMallocHeapSize).
  uint64_t heap_bytes = kDefaultHeapBytes;
  // Refuses registers and numbers whose types PTX does not allow where they stand. Without the check, a test
  // reaches the half of a register that a value of 16 bits leaves open.
  bool check_types = true;
};

// Returns the names of a module's kernels, in the order of the text.
std::vector<std::string> kernel_names(std::string_view text, const std::string& file);

// Compiles one kernel. Functions that it calls become part of it, but for those that call themselves or are
// called through a register. `entry` may be empty when the module has only one kernel. A UserError or
// UnsupportedError lists every mistake, with file, line and column.
Kernel compile_ptx(std::string_view text, const std::string& file, const std::string& entry,
                   const PtxOptions& options);

}  // namespace glint::frontend
