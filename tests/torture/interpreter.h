// Interprets SPIR-V, one invocation and one scalar at a time. It shares no code with the frontend.
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

// Holds all scalars of a value in order. A bool is 0 or 1, integers are zero-extended from their width, and
// floats are their bits. A pointer is two scalars: the memory and the scalar in it.
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
  Scalar scalar;         // scalar of the first part
  Id element = 0;        // element of vectors, matrices and arrays; the pointee of pointers
  uint32_t count = 0;    // number of elements; 0 in a runtime array
  uint32_t scalars = 0;  // number of scalars of a value
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

// Describes the launch that a module is run with. Buffers are of 32-bit words, by binding in set 0, and are
// written in place.
struct ScalarLaunch {
  std::array<uint32_t, 3> threads{1, 1, 1};
  std::map<uint32_t, std::vector<uint32_t>> buffers;
  uint64_t steps_a_lane = 1u << 20;  // beyond them, std::runtime_error is thrown
};

class Interpreter {
 public:
  // Throws std::runtime_error that names what it does not know.
  explicit Interpreter(const std::vector<uint32_t>& words);

  // Runs every invocation to its end, those of a workgroup in turns from barrier to barrier. Returns the
  // steps of the longest.
  uint64_t run(ScalarLaunch& launch) const;

 private:
  struct Invocation;
  using Memories = std::vector<std::vector<uint64_t>>;  // variables: their scalars

  void decode(const std::vector<uint32_t>& words);
  void declare(const Decoded& inst);
  void declare_type(const Decoded& inst);
  void declare_constant(const Decoded& inst);
  void check_layout() const;
  bool step(Invocation& lane) const;  // returns false at a barrier and at the end
  bool step_control(Invocation& lane, const Decoded& inst) const;
  bool step_memory(Invocation& lane, const Decoded& inst) const;
  bool step_composite(Invocation& lane, const Decoded& inst) const;
  void enter_block(Invocation& lane, Id label) const;
  uint64_t run_group(std::vector<Invocation>& lanes, uint64_t most_steps) const;
  // Returns the first scalar of a member. *type becomes the member's type.
  uint32_t first_scalar(Id* type, uint32_t index) const;
  Value builtin(const Invocation& lane, spv::BuiltIn what) const;

  uint32_t bound_ = 0;
  Id glsl_ = 0, entry_ = 0;
  std::array<uint32_t, 3> local_size_{0, 0, 0};
  std::vector<Id> local_size_ids_;  // constants, where it is given so
  std::map<Id, TypeInfo> types_;
  std::vector<Value> constants_;  // by id; other ids have count 0
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

// Computes an op without memory or control, part by part. Returns false when the op is not known.
bool compute(const Decoded& inst, Scalar to, Scalar from, const std::vector<const Value*>& arguments,
             Value* result);
bool compute_glsl(uint32_t function, Scalar to, const std::vector<const Value*>& arguments, Value* result);

// These convert bits and numbers.
float float_of(uint64_t bits);
double double_of(uint64_t bits);
uint64_t bits_of(float x);  // a NaN is the canonical one of PTX
uint64_t bits_of(double x);
int64_t extended(uint64_t x, uint32_t width);  // extends by the sign
uint64_t cut(uint64_t x, uint32_t width);

}  // namespace glint::test::torture
