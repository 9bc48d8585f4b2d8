// Holds a parsed SPIR-V module: types with layout, constants, variables with decorations, blocks with source
// lines.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <spirv/unified1/spirv.hpp11>
#include <string>
#include <utility>
#include <vector>

#include "isa/program.h"

namespace glint::frontend {

using Id = uint32_t;  // a SPIR-V result id; 0 is none

struct Type {
  enum class Kind : uint8_t {
    Void,
    Bool,
    Int,
    Float,
    Vector,
    Matrix,
    Array,
    RuntimeArray,
    Struct,
    Pointer,
    Image,
    Sampler,
    SampledImage,
    AccelerationStructure,
    RayQuery,
    Function,
    Other
  } kind = Kind::Other;
  uint32_t width = 0;      // Int, Float: bits
  bool is_signed = false;  // Int
  Id element = 0;  // Vector, Matrix (column), arrays, Pointer (pointee), SampledImage (image), Image (texel)
  uint32_t count = 0;           // Vector, Matrix (columns), Array: elements
  uint32_t array_stride = 0;    // bytes; 0: not decorated
  spv::StorageClass storage{};  // Pointer
  spv::Dim dim{};               // Image
  spv::ImageFormat format{};    // Image
  bool is_storage_image = false, is_arrayed = false, is_multisampled = false;  // Image
  bool is_block = false;  // Struct: decorated Block or BufferBlock
  // This is true for a Struct that is decorated BufferBlock, which makes a storage buffer of storage class
  // Uniform.
  bool is_buffer_block = false;
  struct Member {
    Id type = 0;
    std::optional<uint32_t> offset;  // bytes
    uint32_t matrix_stride = 0;      // bytes
    bool row_major = false;
    bool is_volatile = false;  // also true for coherent members
    std::optional<spv::BuiltIn> builtin;
    std::string name;
  };
  std::vector<Member> members;  // Struct
  std::string name;
  spv::Op op{};  // the declaration's opcode, for messages
};

struct Instruction {
  spv::Op op{};
  Id type = 0, result = 0;
  std::vector<uint32_t> operands;  // words after type and result
  uint32_t literal_words = 1;      // OpSwitch: words of a literal, by the width of the selector
  isa::Line line;
};

struct Block {
  Id label = 0;
  std::vector<Instruction> code;   // phis first; the last instruction is the terminator
  spv::Op merge = spv::Op::OpNop;  // OpSelectionMerge, OpLoopMerge or OpNop
  Id merge_block = 0, continue_block = 0;
  isa::Line merge_line;

  const Instruction& terminator() const { return code.back(); }
  std::vector<Id> successors() const;  // in the terminator's order, with duplicates
};

struct Function {
  Id id = 0;
  std::vector<Block> blocks;
};

struct Variable {
  Id id = 0, type = 0;  // `type` is the type of the pointer
  spv::StorageClass storage{};
  Id initializer = 0;
  isa::Line line;
};

struct Decorations {
  std::optional<uint32_t> set, binding;
  std::optional<spv::BuiltIn> builtin;
  bool is_volatile = false;
  bool is_coherent = false;
  bool no_contraction = false;  // of a result: GLSL's `precise`
};

struct EntryPoint {
  spv::ExecutionModel model{};
  Id function = 0;
  std::string name;
  std::array<uint32_t, 3> local_size{1, 1, 1};
  std::set<Id> interface;  // since SPIR-V 1.4: all variables at module level that the entry point uses
};

// Returns the stage of an execution model; empty for models that have no stage in Glint.
std::optional<isa::Stage> stage_of(spv::ExecutionModel model);

struct Module {
  Id bound = 0;
  uint32_t version = 0;  // 0x10600 is 1.6
  std::vector<std::pair<spv::Capability, isa::Line>> capabilities;
  std::map<Id, Type> types;
  // Holds OpConstant*, OpSpecConstant* that are not frozen, and OpUndef at module level.
  std::map<Id, Instruction> constants;
  std::map<Id, Variable> variables;  // variables at module level
  std::map<Id, Decorations> decorations;
  std::map<Id, std::string> names;
  std::map<Id, std::string> imports;  // from OpExtInstImport
  std::map<Id, std::string> strings;  // from OpString: names of files, formats of prints
  std::vector<EntryPoint> entry_points;
  std::vector<Function> functions;
  // The numbers isa::Line::file, ::spirv and ::scope of instructions refer to these lists.
  std::vector<std::string> files;
  std::vector<isa::Line> lines;
  std::vector<isa::Scope> scopes;

  // Parses a module, which should have been validated. Throws UserError when the words are not well formed.
  static Module parse(const std::vector<uint32_t>& words, const std::string& name);

  const Type& type(Id id) const;
  std::optional<uint32_t> constant_u32(Id id) const;  // value of a 32-bit integer constant
  std::string name_of(Id id) const;                   // the debug name, or "%id"
  const Function* function(Id id) const;
  // Returns the entry point of that name; an empty name means the only one. Throws UserError with the names
  // of the module's entry points.
  const EntryPoint& entry_point(const std::string& wanted, const std::string& file) const;
};

}  // namespace glint::frontend
