// A scalar interpreter of SPIR-V: one invocation at a time, on its own reading of the words; shares no code
// with the frontend.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <spirv/unified1/spirv.hpp11>
#include <string>
#include <utility>
#include <vector>

namespace glint::test::torture {

using Id = uint32_t;

// All scalars of a value in order. Bool: 0 or 1; integers zero-extended from their width; floats: their bits.
// A pointer is two scalars: the memory and the scalar in it.
struct Value {
  static constexpr size_t kMost = 20;
  uint32_t count = 0;
  std::array<uint64_t, kMost> part{};
};

struct Scalar {
  enum class Kind : uint8_t { Bool, Int, Float } kind = Kind::Int;
  uint32_t width = 32;
};

struct TypeInfo {
  spv::Op op{};
  Scalar scalar;         // of the first part
  Id element = 0;        // of vectors, matrices, arrays; the pointee of pointers
  uint32_t count = 0;    // elements; 0 in a runtime array
  uint32_t scalars = 0;  // of a value
  std::vector<Id> members;
};

struct Decoded {
  spv::Op op{};
  Id type = 0, result = 0;
  std::vector<uint32_t> operands;  // what follows type and result
};

struct FunctionCode {
  Id type = 0;
  std::vector<Id> parameters;
  std::vector<Decoded> code;
  std::map<Id, uint32_t> at_label;
};

// The launch that a module is run with. Buffers are of 32-bit words, by binding in set 0, and are written in
// place.
struct ScalarLaunch {
  std::array<uint32_t, 3> threads{1, 1, 1};
  std::map<uint32_t, std::vector<uint32_t>> buffers;
  uint64_t steps_a_lane = 1u << 20;  // more: std::runtime_error
};

class Interpreter {
 public:
  // std::runtime_error names what it does not know.
  explicit Interpreter(const std::vector<uint32_t>& words);

  // Every invocation to its end, those of a workgroup in turns from barrier to barrier. Returns the longest's
  // steps.
  uint64_t run(ScalarLaunch& launch) const;

 private:
  struct Invocation;
  using Memories = std::vector<std::vector<uint64_t>>;  // variables: their scalars

  void decode(const std::vector<uint32_t>& words);
  void declare(const Decoded& inst);
  void declare_type(const Decoded& inst);
  void declare_constant(const Decoded& inst);
  void check_layout() const;
  bool step(Invocation& lane) const;  // false at a barrier and at the end
  bool step_control(Invocation& lane, const Decoded& inst) const;
  bool step_memory(Invocation& lane, const Decoded& inst) const;
  bool step_composite(Invocation& lane, const Decoded& inst) const;
  void enter_block(Invocation& lane, Id label) const;
  uint64_t run_group(std::vector<Invocation>& lanes, uint64_t most_steps) const;
  uint32_t first_scalar(Id* type, uint32_t index) const;  // of a member; then *type is the member's
  Value builtin(const Invocation& lane, spv::BuiltIn what) const;

  uint32_t bound_ = 0;
  Id glsl_ = 0, entry_ = 0;
  std::array<uint32_t, 3> local_size_{0, 0, 0};
  std::vector<Id> local_size_ids_;  // constants, where it is given so
  std::map<Id, TypeInfo> types_;
  std::vector<Value> constants_;  // by id; other values have count 0
  std::vector<Id> type_of_;       // by id
  std::map<Id, FunctionCode> functions_;
  std::map<Id, uint32_t> binding_of_;
  std::map<Id, spv::BuiltIn> builtin_of_;
  struct GlobalVariable {
    Id id, type;
    spv::StorageClass storage;
    Id initializer;
  };
  std::vector<GlobalVariable> globals_;
  std::map<Id, uint32_t> array_stride_;
  std::map<std::pair<Id, uint32_t>, uint32_t> member_offset_;
};

// What an op without memory or control computes, part by part; false when it is none of those known.
bool compute(const Decoded& inst, Scalar to, Scalar from, const std::vector<const Value*>& arguments,
             Value* result);
bool compute_glsl(uint32_t function, Scalar to, const std::vector<const Value*>& arguments, Value* result);

// Bits and numbers.
float float_of(uint64_t bits);
double double_of(uint64_t bits);
uint64_t bits_of(float x);  // a NaN is the canonical one of PTX
uint64_t bits_of(double x);
int64_t extended(uint64_t x, uint32_t width);  // by its sign
uint64_t cut(uint64_t x, uint32_t width);

}  // namespace glint::test::torture
