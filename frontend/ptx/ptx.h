// PTX text in, one kernel's isa::Program out, with what a launch must know: parameters, variables, shared
// memory. SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "frontend/compile.h"
#include "isa/program.h"

namespace glint::frontend {

// A parameter of a kernel, in PTX's layout; `offset` counts from isa::kPushConstantOffset of the constant
// bank.
struct KernelParameter {
  std::string name;
  uint32_t offset = 0, bytes = 0;
};

// A variable of the module, which the launch must place and fill.
struct ModuleVariable {
  // The address of `symbol` plus `addend`, 8 bytes, stands at `at`.
  struct Pointer {
    uint64_t at = 0;
    std::string symbol;
    uint64_t addend = 0;
  };
  std::string name;
  bool is_constant = false;  // lies in the constant bank at `offset`; else in global memory
  uint32_t offset = 0;       // global: the constant bank holds its address, 8 bytes, at `offset`
  uint64_t bytes = 0;
  std::vector<std::byte> initial;  // zeros after its end
  std::vector<Pointer> pointers;
};

struct Kernel {
  isa::Program program;  // shared_bytes: the static part
  std::vector<KernelParameter> parameters;
  std::vector<ModuleVariable> variables;
  uint32_t constant_bank_bytes = isa::kConstantBankBytes;                // the least that it needs
  std::optional<std::array<uint32_t, 3>> required_block, largest_block;  // .reqntid, .maxntid
};

struct PtxOptions {
  BackendOptions backend;
  // mul, then add or sub, none with a rounding modifier, become fma where nothing else reads the product.
  // Choice: PTX allows it ("may be optimized aggressively"), and NVIDIA's assembler does it unless told
  // -fmad=false.
  bool contract = true;
  // What the hardware's assembler does besides (frontend/ptx/machine.h): fewer instructions, the same
  // results.
  bool shape = true;
};

// Kernels of a module, in the order of the text.
std::vector<std::string> kernel_names(std::string_view text, const std::string& file);

// Compiles one kernel; functions that it calls become part of it. `entry` may be empty when there is one
// kernel only. UserError or UnsupportedError list every mistake at once, with file, line and column.
Kernel compile_ptx(std::string_view text, const std::string& file, const std::string& entry,
                   const PtxOptions& options);

}  // namespace glint::frontend
