// A compiled shader: instructions, constant rows, source lines, and what a machine must provide to run it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "isa/inst.h"

namespace glint::isa {

enum class Stage : uint8_t { RayGeneration, Intersection, AnyHit, ClosestHit, Miss, Callable, Compute };

// Where an instruction comes from. file indexes Program::files; line counts from 1, 0 = unknown.
struct Line {
  uint16_t file = 0;
  uint32_t line = 0;
  // Known to the compiler alone: no part of a program's text, and lines are equal without them.
  uint32_t spirv = 0;  // row of Program::spirv, from 1; 0 = unknown
  uint32_t scope = 0;  // row of Program::scopes, from 1; 0 = unknown
  bool operator==(const Line& other) const { return file == other.file && line == other.line; }
};

// A function's body as it was inlined: one for each chain of calls that leads to it.
struct Scope {
  std::string function;
  uint32_t caller = 0;  // row of Program::scopes, from 1 and below its own; 0 = none, the entry point
  Line call;            // where the caller calls it
};

// An instruction of the SPIR-V module as it was lowered, and the source line it stands for.
struct SpirvLine {
  std::string text;
  Line line;
};

// Constant-bank layout that compiler and pipeline agree on. Descriptor of (set, binding) at
// set * kSetBytes + binding * kDescriptorBytes: { u64 address or handle, u64 bytes or count }.
inline constexpr uint32_t kDescriptorBytes = 16;
inline constexpr uint32_t kBindingsPerSet = 64;
inline constexpr uint32_t kSetBytes = kBindingsPerSet * kDescriptorBytes;  // 1 KiB
inline constexpr uint32_t kMaxSets = 16;
inline constexpr uint32_t kPushConstantOffset = kMaxSets * kSetBytes;  // 16 KiB
inline constexpr uint32_t kConstantBankBytes = kPushConstantOffset + 1024;

// Register %r0 holds the local-memory stack pointer of the lane; a caller adds its own local_bytes to it
// before call.sbt.* and subtracts it after. All other registers and all predicates are caller-saved.
inline constexpr Slot kStackPointer = 0;

struct Program {
  std::string name;  // for messages: the shader's file name
  Stage stage = Stage::Compute;
  std::vector<Inst> code;           // entry is instruction 0
  std::vector<uint32_t> constants;  // one value a row; broadcast to 32 lanes when loaded into a machine
  std::vector<std::string> files;
  std::vector<Line> lines;                               // one an instruction
  std::vector<std::pair<uint32_t, std::string>> labels;  // instruction index, name; sorted by index
  uint32_t num_registers = 1;                            // highest register + 1
  uint32_t local_bytes = 0;    // stack frame: variables, payloads, spills, saved registers
  uint32_t payload_bytes = 0;  // of the payload it reads (hit, miss) or the largest it passes (caller)
  uint32_t attribute_bytes = 0;
  std::array<uint32_t, 3> local_size{1, 1, 1};  // compute: threads of a block
  uint32_t shared_bytes = 0;                    // compute: shared memory of a block
  std::vector<std::string> messages;            // formats of print and print.part (isa/message.h)
  // For people, from the compiler: not in the program's text, and not compared.
  std::vector<Scope> scopes;
  std::vector<SpirvLine> spirv;

  bool operator==(const Program&) const;  // code, constants, lines, header fields: "the identical program"
};

}  // namespace glint::isa
