// Holds random structured programs as trees, which generator, writers of GLSL and SPIR-V, and minimiser
// share.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::test::torture {

// Draws random numbers by Splitmix64, which gives the same programs from the same seed everywhere.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}
  uint64_t bits() {
    uint64_t x = state_ += 0x9e37'79b9'7f4a'7c15ull;
    x = (x ^ x >> 30) * 0xbf58'476d'1ce4'e5b9ull;
    x = (x ^ x >> 27) * 0x94d0'49bb'1331'11ebull;
    return x ^ x >> 31;
  }
  uint32_t below(uint32_t n) { return uint32_t((bits() >> 32) * n >> 32); }
  bool chance(uint32_t percent) { return below(100) < percent; }

 private:
  uint64_t state_;
};

enum class Sort : uint8_t { Word, Bool, Float };

struct Expr {
  enum class Op : uint8_t {
    // These are words.
    Constant,
    Variable,
    Lane,
    Input,
    Element,
    Own,
    Add,
    Sub,
    Mul,
    And,
    Or,
    Xor,
    Shl,
    Shr,
    Div,
    Mod,
    Select,
    Truncate,
    // These are bools.
    BoolVariable,
    Less,
    SignedLess,
    Equal,
    FloatLess,
    Both,
    Either,
    Not,
    // These are floats.
    FloatVariable,
    FloatConstant,
    FloatAdd,
    FloatMul,
    ToFloat,
    FloatSelect
  } op = Op::Constant;
  uint32_t value = 0;  // constant's bits or variable's number
  std::vector<Expr> args;
};

struct Stmt {
  enum class Kind : uint8_t {
    Assign,      // variable `value` = args[0]
    Trace,       // the hash takes up `value` and args[0]
    SetElement,  // element args[0] of the local array = args[1]
    SetOwn,      // word args[0] of the lane's own part of a buffer = args[1]
    If,          // args[0]; bodies: then, else
    Loop,    // at most (args[0] & 3) + 1 times, while args[1]; counter `value`; bodies: body, continue target
    Switch,  // args[0] & 7; bodies: the cases
    Call,    // variable `value` = function `other` (args[0], args[1])
    Exchange,  // words through shared memory, between barriers, with the lane `value` further
    Break,
    Continue,
    Return,
    LoopBreak,  // from inside a switch out of the loop around it; SPIR-V only, like all below
    Leave,      // to the end of the `if` whose branch this list is
    NextCase,   // to the next case of the switch whose case this list is
  } kind = Kind::Trace;
  // This is the style of a loop. A Single loop is one block. The header of a SkipFirst loop goes to the body
  // or to the continue target.
  enum class Style : uint8_t { While, HeaderTest, DoWhile, Endless, Single, SkipFirst } style = Style::While;
  bool bare = false;  // If: a conditional branch without a merge, because its only statement is an exit
  // It is used by If, Switch and Loop. If true, code goes on where nothing arrives; otherwise OpUnreachable
  // is there.
  bool dead = false;
  uint32_t value = 0, other = 0;
  std::vector<Expr> args;
  std::vector<std::vector<Stmt>> bodies;
  std::vector<std::vector<uint32_t>> labels;  // of the cases
  std::vector<uint8_t> falls;                 // the case goes on into the next one
  int default_case = -1;                      // none: to the end
};

struct FunctionTree {
  // Word 0 is the hash. Words 1 and 2 start as the arguments, or as the lane and an input.
  std::vector<Sort> variables;
  std::vector<uint8_t> in_memory;
  std::vector<Stmt> body;
};

struct ProgramTree {
  uint64_t seed = 0;
  bool spirv = true;       // may have shapes that GLSL does not have
  bool is_compute = true;  // otherwise ray generation
  uint32_t group = 32, groups = 2;
  std::vector<FunctionTree> functions;  // the last is the entry point; each calls those before it
};

inline constexpr uint32_t kInputWords = 64, kOwnWords = 4, kElements = 4;
// These are the bindings of storage buffers.
inline constexpr uint32_t kInputBinding = 0, kResultBinding = 1, kOwnBinding = 2;

ProgramTree generate(uint64_t seed, bool spirv);
std::string to_glsl(const ProgramTree& program);
std::vector<uint32_t> to_spirv(const ProgramTree& program);
size_t count_statements(const ProgramTree& program);

}  // namespace glint::test::torture
