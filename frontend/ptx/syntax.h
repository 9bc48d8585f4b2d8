// Holds a PTX module as its text says it: declarations, functions, instructions. Nothing is resolved yet.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "frontend/ptx/tokens.h"

namespace glint::frontend::ptx {

// Holds a fundamental type: b8..b128, u8..u64, s8..s64, f16, bf16, f16x2, bf16x2, f32, f64, pred and similar
// ones.
struct Type {
  char kind = 'b';  // b, u, s, f; p for pred
  uint32_t bits = 32;
};
// Returns the type that a word names, or nothing when the word is not a type.
std::optional<Type> type_of(const std::string& word);

struct Operand {
  enum class Kind : uint8_t {
    Sink,  // _
    // Names a register, variable, label or function. `element` is the x of %tid.x, and `offset` the 4 of `x +
    // 4`.
    Name,
    Integer,
    Float32,
    Float64,  // `value` holds the bits
    Vector,   // {a, b}: `parts`
    Address,  // [parts[0] + offset, more parts]
    Pair,     // a|b: `parts`
    List      // (a, b) of a call: `parts`
  } kind = Kind::Sink;
  std::string name, element;
  bool negated = false;  // for !name
  uint64_t value = 0;
  int64_t offset = 0;
  std::vector<Operand> parts;
  TextPosition position;
};

struct Instruction {
  std::vector<std::string> words;  // words of the opcode, such as {"ld", "global", "f32"}
  std::vector<Operand> operands;
  std::string guard;  // name of a predicate, or empty
  bool guard_negated = false;
  TextPosition position;
};

enum class VariableSpace : uint8_t { Register, Shared, Local, Const, Global, Param };

struct Initializer {
  uint64_t value = 0;  // bits of the element type
  std::string symbol;  // not empty: the value is the address of the symbol plus `value`
};

struct Declaration {
  VariableSpace space = VariableSpace::Register;
  Type type;
  uint32_t vector = 1;  // .v2, .v4
  uint32_t align = 0;   // 0: natural alignment
  std::string name;
  uint32_t range = 0;  // %r<10>: 10 registers named %r0 to %r9
  std::vector<uint64_t> dimensions;
  bool is_extern = false, has_open_dimension = false;
  std::vector<Initializer> initial;
  TextPosition position;

  uint64_t count() const;  // number of elements over all dimensions
  uint64_t bytes() const { return count() * vector * type.bits / 8; }
  uint32_t alignment() const { return align ? align : vector * type.bits / 8; }
};

// Says what a function gives and takes.
struct Signature {
  std::vector<Declaration> results, parameters;
};

struct Statement {
  enum class Kind : uint8_t {
    Label,
    Instruction,
    Declaration,
    Scope,
    Targets,      // .branchtargets
    CallTargets,  // .calltargets
    Prototype,    // .callprototype
    Pragma
  } kind = Kind::Instruction;
  std::string label;  // of a Label; for lists and prototypes, their name; for a Pragma, its text
  Instruction instruction;
  Declaration declaration;
  std::vector<Statement> body;       // of a Scope
  std::vector<std::string> targets;  // of Targets and CallTargets
  Signature signature;               // of a Prototype
  TextPosition position;
};

struct Function : Signature {
  std::string name;
  bool is_entry = false, has_body = false;
  std::vector<Statement> body;
  std::optional<std::array<uint32_t, 3>> required_block, largest_block;  // .reqntid, .maxntid
  std::optional<std::array<uint32_t, 3>> required_cluster;               // .reqnctapercluster
  TextPosition position;
};

struct Module {
  std::string file;
  uint32_t address_size = 64;
  std::vector<Declaration> variables;
  std::vector<Function> functions;
};

// Reads a module. Throws UserError that says what was expected and what was found.
Module parse(std::string_view text, const std::string& file);

}  // namespace glint::frontend::ptx
