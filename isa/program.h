// Holds a compiled shader: instructions, constant rows, source lines, and what a machine must provide to run
// it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "isa/inst.h"
#include "isa/stage.h"

namespace glint::isa {

// Says where an instruction comes from. `file` indexes Program::files, and `line` counts from 1; 0 means
// unknown.
struct Line {
  uint16_t file = 0;
  uint32_t line = 0;
  // Only the compiler knows these. They are not part of a program's text, and lines compare equal without
  // them.
  uint32_t spirv = 0;  // row of Program::spirv, from 1; 0 = unknown
  uint32_t scope = 0;  // row of Program::scopes, from 1; 0 = unknown
  bool operator==(const Line& other) const { return file == other.file && line == other.line; }
};

// Names an inlined function body. Each chain of calls that leads to the function has its own scope.
struct Scope {
  std::string function;
  uint32_t caller = 0;  // row of Program::scopes, from 1, lower than its own; 0: the entry point
  Line call;            // place of the call in the caller
};

// Holds an instruction of the SPIR-V module as it was lowered, and its source line.
struct SpirvLine {
  std::string text;
  Line line;
};

// Defines the layout of the constant bank, on which compiler and pipeline agree. The descriptor of (set,
// binding) is at set * kSetBytes + binding * kDescriptorBytes: { u64 address or handle, u64 bytes or count }.
inline constexpr uint32_t kDescriptorBytes = 16;
inline constexpr uint32_t kBindingsPerSet = 64;
inline constexpr uint32_t kSetBytes = kBindingsPerSet * kDescriptorBytes;  // 1 KiB
inline constexpr uint32_t kMaxSets = 16;
inline constexpr uint32_t kPushConstantOffset = kMaxSets * kSetBytes;  // 16 KiB
inline constexpr uint32_t kConstantBankBytes = kPushConstantOffset + 1024;

// Register %r0 holds the local-memory stack pointer of the lane. A caller adds its own local_bytes to it
// before call.sbt.* and subtracts them after it. All other registers and all predicates are caller-saved.
inline constexpr Slot kStackPointer = 0;

struct Program {
  std::string name;  // the shader's file name, for messages
  Stage stage = Stage::Compute;
  std::vector<Inst> code;           // instruction 0 is the entry
  std::vector<uint32_t> constants;  // one value per row; a machine broadcasts it to 32 lanes
  std::vector<std::string> files;
  std::vector<Line> lines;                               // one per instruction
  std::vector<std::pair<uint32_t, std::string>> labels;  // instruction index, name; sorted by index
  uint32_t num_registers = 1;                            // highest register + 1
  uint32_t local_bytes = 0;    // bytes of the stack frame: variables, payloads, spills, saved registers
  uint32_t function = 0;       // number by which call.function calls it; 0: nothing calls the program
  uint32_t payload_bytes = 0;  // of the payload it reads (hit, miss) or the largest it passes (caller)
  uint32_t attribute_bytes = 0;
  std::array<uint32_t, 3> local_size{1, 1, 1};  // compute: threads of a block
  uint32_t shared_bytes = 0;                    // compute: bytes of shared memory of a block
  std::vector<std::string> messages;            // formats of print and print.part (isa/message.h)
  // These lists from the compiler are for people. They are not in the program's text and are not compared.
  std::vector<Scope> scopes;
  std::vector<SpirvLine> spirv;

  bool operator==(const Program&) const;  // compares code, constants, lines and header fields
  // Returns whether a launch starts it: whether it ends with exit, and %r0 is 0 at its start.
  bool is_entry() const {
    return (stage == Stage::RayGeneration || stage == Stage::Compute) && function == 0;
  }
};

}  // namespace glint::isa
